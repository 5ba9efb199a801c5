/// \file A prepared statement while it is in use.
/// Private to protocols/store: with database.hpp the only headers here that show SQLiteCpp.
#pragma once

#include "core/bytes.hpp"

#include <concepts>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include <SQLiteCpp/Column.h>
#include <SQLiteCpp/Statement.h>

namespace touchtrial::store {

/// Binds parameters from left to right, then steps through rows. The statement is reset when this
/// goes, so that no read transaction stays open. Blobs are not copied: they must live until the
/// last step.
class Query {
 public:
  explicit Query(SQLite::Statement& statement) : statement_(&statement) {}
  explicit Query(std::unique_ptr<SQLite::Statement> owned)
      : owned_(std::move(owned)), statement_(owned_.get()) {}
  ~Query() { statement_->tryReset(); }
  Query(const Query&) = delete;
  Query& operator=(const Query&) = delete;

  template <std::integral Number>
  Query& bind(Number value) {
    statement_->bind(++bound_, std::int64_t{value});
    return *this;
  }
  template <typename Value>
  Query& bind(const std::optional<Value>& value) {
    if (value) return bind(*value);
    statement_->bind(++bound_);
    return *this;
  }
  Query& bind(double value) {
    statement_->bind(++bound_, value);
    return *this;
  }
  Query& bind(std::string_view text) {
    statement_->bind(++bound_, std::string(text));
    return *this;
  }
  Query& bind(ByteView blob);
  Query& bind(std::monostate) {
    statement_->bind(++bound_);
    return *this;
  }
  /// Whatever of these it holds; std::monostate is NULL.
  template <typename... Values>
  Query& bind(const std::variant<std::monostate, Values...>& value) {
    return std::visit([this](const auto& held) -> Query& { return this->bind(held); }, value);
  }

  /// \return whether there is a (further) row
  [[nodiscard]] bool step() { return statement_->executeStep(); }
  /// For statements without rows.
  void run() { statement_->exec(); }

  [[nodiscard]] std::int64_t integer(int column) const;
  [[nodiscard]] double real(int column) const;
  [[nodiscard]] std::string text(int column) const;
  [[nodiscard]] Bytes blob(int column) const;
  [[nodiscard]] bool is_null(int column) const;

 private:
  std::unique_ptr<SQLite::Statement> owned_;
  SQLite::Statement* statement_;
  int bound_ = 0;
};

}  // namespace touchtrial::store
