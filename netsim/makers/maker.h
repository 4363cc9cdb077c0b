#pragma once

#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace cuscus::netsim {

/// A row of a table of models: a name, as a scenario has it, and what makes the model.
template <typename Model, typename... Setting>
struct Maker {
  std::string_view name;
  std::unique_ptr<Model> (*make)(const Setting&... setting);
};

/// The row of that name in our own table or in `more`, the rows of a program that extends us.
/// @throws std::invalid_argument naming the rows that there are.
template <typename Row>
[[nodiscard]] const Row& find_maker(std::string_view what, std::string_view name,
                                    std::span<const Row> ours, std::span<const Row> more) {
  std::string allowed;
  for (const std::span<const Row> table : {ours, more}) {
    for (const Row& row : table) {
      if (row.name == name) {
        return row;
      }
      allowed += (allowed.empty() ? "'" : ", '") + std::string{row.name} + "'";
    }
  }
  throw std::invalid_argument{std::string{what} + " '" + std::string{name} +
                              "' is not known; allowed are " + allowed};
}

}  // namespace cuscus::netsim
