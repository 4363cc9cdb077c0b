#include "ground-station/core/json_writer.h"

#include <array>
#include <charconv>
#include <cmath>
#include <utility>

namespace cuscus::gcs {
namespace {

constexpr double kLargest = 1e15;  // beyond, a double is no exact integer and its text is long

unsigned char byte_at(std::string_view text, std::size_t at) {
  return static_cast<unsigned char>(text[at]);
}

/// Length of the well-formed UTF-8 sequence at `at`, 0 when there is none.
/// Source: The Unicode Standard 15.0, table 3-7.
std::size_t utf8_length(std::string_view text, std::size_t at) {
  const unsigned char first = byte_at(text, at);
  std::size_t length = 0;
  unsigned char low = 0x80;
  unsigned char high = 0xBF;
  if (first < 0x80) {
    return 1;
  }
  if (first >= 0xC2 && first <= 0xDF) {
    length = 2;
  } else if (first >= 0xE0 && first <= 0xEF) {
    length = 3;
    low = first == 0xE0 ? 0xA0 : low;
    high = first == 0xED ? 0x9F : high;
  } else if (first >= 0xF0 && first <= 0xF4) {
    length = 4;
    low = first == 0xF0 ? 0x90 : low;
    high = first == 0xF4 ? 0x8F : high;
  }
  if (length == 0 || at + length > text.size() || byte_at(text, at + 1) < low ||
      byte_at(text, at + 1) > high) {
    return 0;
  }
  for (std::size_t i = 2; i < length; ++i) {
    if (byte_at(text, at + i) < 0x80 || byte_at(text, at + i) > 0xBF) {
      return 0;
    }
  }
  return length;
}

bool is_escaped(unsigned char c) {
  return c < 0x20 || c == 0x7F || c == '"' || c == '\\' || c == '<' || c == '>' || c == '&' ||
         c == '\'';
}

}  // namespace

void JsonWriter::separate() {
  if (comma_due_) {
    text_ += ',';
  }
  comma_due_ = true;
}

void JsonWriter::begin_object() {
  separate();
  text_ += '{';
  comma_due_ = false;
}

void JsonWriter::end_object() {
  text_ += '}';
  comma_due_ = true;
}

void JsonWriter::begin_array() {
  separate();
  text_ += '[';
  comma_due_ = false;
}

void JsonWriter::end_array() {
  text_ += ']';
  comma_due_ = true;
}

void JsonWriter::key(std::string_view name) {
  separate();
  text_ += '"';
  text_ += name;
  text_ += "\":";
  comma_due_ = false;
}

void JsonWriter::string(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  separate();
  text_ += '"';
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t length = utf8_length(text, at);
    const unsigned char c = byte_at(text, at);
    if (length == 0) {
      text_ += "\\ufffd";
    } else if (length == 1 && is_escaped(c)) {
      text_ += "\\u00";
      text_ += kDigits[c >> 4U];
      text_ += kDigits[c & 0xFU];
    } else {
      text_ += text.substr(at, length);
    }
    at += length == 0 ? 1 : length;
  }
  text_ += '"';
}

void JsonWriter::number(double value, int decimals) {
  if (!std::isfinite(value) || std::abs(value) > kLargest) {
    null();
    return;
  }
  separate();
  std::array<char, 48> digits;
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value,
                                          std::chars_format::fixed, decimals);
  std::string_view text{digits.data(), static_cast<std::size_t>(end - digits.data())};
  if (text.find('.') != std::string_view::npos) {
    text = text.substr(0, text.find_last_not_of('0') + 1);
    text.remove_suffix(text.back() == '.' ? 1 : 0);
  }
  text_ += text == "-0" ? "0" : text;
}

void JsonWriter::integer(std::uint64_t value) {
  separate();
  std::array<char, 20> digits;
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  text_.append(digits.data(), end);
}

void JsonWriter::boolean(bool value) {
  separate();
  text_ += value ? "true" : "false";
}

void JsonWriter::null() {
  separate();
  text_ += "null";
}

std::string JsonWriter::take() && { return std::move(text_); }

}  // namespace cuscus::gcs
