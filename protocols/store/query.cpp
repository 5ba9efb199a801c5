#include "protocols/store/query.hpp"

#include "core/errors.hpp"

#include <limits>

namespace touchtrial::store {

Query& Query::bind(ByteView blob) {
  if (blob.size() > std::size_t{std::numeric_limits<int>::max()}) {
    throw StoreError("a trace is larger than a database can hold; shorten trials.explore_limit_s");
  }
  // A null pointer would be stored as NULL, which no column of ours allows.
  const void* data = blob.empty() ? static_cast<const void*>("") : blob.data();
  statement_->bindNoCopy(++bound_, data, static_cast<int>(blob.size()));
  return *this;
}

std::int64_t Query::integer(int column) const {
  return statement_->getColumn(column).getInt64();
}

double Query::real(int column) const {
  return statement_->getColumn(column).getDouble();
}

std::string Query::text(int column) const {
  return statement_->getColumn(column).getString();
}

Bytes Query::blob(int column) const {
  const SQLite::Column value = statement_->getColumn(column);
  // The pointer first: asking for the size of another type may convert it.
  const auto* data = static_cast<const std::uint8_t*>(value.getBlob());
  const auto size = static_cast<std::size_t>(value.getBytes());
  return data == nullptr ? Bytes() : Bytes(data, data + size);
}

bool Query::is_null(int column) const {
  return statement_->isColumnNull(column);
}

}  // namespace touchtrial::store
