#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace cuscus::gcs {

/// Writes JSON text piece by piece, in the order of the calls; puts the commas.
///
/// Ten pictures a second with thousands of numbers are written with it: a document tree would
/// cost ten times as much, and print floats with seventeen digits.
class JsonWriter {
 public:
  void begin_object();
  void end_object();
  void begin_array();
  void end_array();
  /// `name` is written as it is: a literal.
  void key(std::string_view name);
  /// Any bytes: what is not UTF-8 becomes U+FFFD; control characters, quotes, and < > & are
  /// escaped.
  void string(std::string_view text);
  /// With at most `decimals` digits after the point; null when not finite.
  void number(double value, int decimals);
  void integer(std::uint64_t value);
  void boolean(bool value);
  void null();

  [[nodiscard]] std::string take() &&;
  void reserve(std::size_t bytes) { text_.reserve(bytes); }

 private:
  void separate();

  std::string text_;
  bool comma_due_{false};
};

}  // namespace cuscus::gcs
