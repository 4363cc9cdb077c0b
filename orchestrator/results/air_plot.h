#pragma once

#include <filesystem>
#include <string>

namespace cuscus::orchestrator {

/// The files of one plot, beside its table.
struct AirPlotFiles {
  std::filesystem::path table;   ///< CSV as cuscus-air writes it.
  std::filesystem::path script;  ///< For gnuplot.
  std::filesystem::path svg;
  std::filesystem::path png;

  /// Beside `table`, with its name.
  [[nodiscard]] static AirPlotFiles beside(const std::filesystem::path& table);
};

/// A gnuplot script, to be run in the folder of its files, that draws goodput, delivery and delay
/// of the table over the number of nodes, or over the seed where that number is only one. A point
/// per run, a line through the means of those with the same number.
[[nodiscard]] std::string air_plot_script(const AirPlotFiles& files, const std::string& title,
                                          bool over_nodes);

}  // namespace cuscus::orchestrator
