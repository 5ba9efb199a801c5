/// \file Columns of many rows as one parameter of a statement: PostgreSQL's text form of arrays.
/// Private to protocols/collect.
#pragma once

#include "core/bytes.hpp"

#include <charconv>
#include <concepts>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace touchtrial::collect {

/// "{1,NULL,\"text\"}", to be cast to the column's type in SQL.
class ServerArray {
 public:
  template <std::integral Number>
  void add(Number value) {
    add_bare(std::to_string(value));
  }
  /// With as many digits as it takes to come back the same.
  void add(double value) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    add_bare({text, static_cast<std::size_t>(end - text)});
  }
  void add(std::string_view text) {
    separate();
    values_ += '"';
    for (const char character : text) {
      if (character == '"' || character == '\\') values_ += '\\';
      values_ += character;
    }
    values_ += '"';
  }
  void add(ByteView bytes) { add(std::string_view("\\x" + to_hex(bytes))); }
  template <typename Value>
  void add(const std::optional<Value>& value) {
    if (value) return add(*value);
    add_bare("NULL");
  }

  void add(std::monostate) { add_bare("NULL"); }
  template <typename... Values>
  void add(const std::variant<std::monostate, Values...>& value) {
    std::visit([this](const auto& held) { this->add(held); }, value);
  }

  /// How long it is so far, in bytes.
  [[nodiscard]] std::size_t size() const noexcept { return values_.size(); }
  [[nodiscard]] std::string text() const { return "{" + values_ + "}"; }

 private:
  void separate() {
    if (!values_.empty()) values_ += ',';
  }
  void add_bare(std::string_view text) {
    separate();
    values_ += text;
  }

  std::string values_;
};

}  // namespace touchtrial::collect
