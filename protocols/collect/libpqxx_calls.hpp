/// \file The calls of libpqxx that its versions 6, 7.5 and 7.10 name differently. Private to
/// protocols/collect.
#pragma once

#include "core/bytes.hpp"

#include <cstddef>
#include <string>
#include <type_traits>
#include <vector>

#include <pqxx/pqxx>

namespace touchtrial::collect {

/// Bytes as a statement's parameter, sent in binary form; and from a row's field.
#if PQXX_VERSION_MAJOR >= 7
using Binary = std::basic_string<std::byte>;
[[nodiscard]] inline Binary binary(ByteView bytes) {
  return {reinterpret_cast<const std::byte*>(bytes.data()), bytes.size()};
}
[[nodiscard]] inline Bytes bytes_of(const pqxx::field& field) {
  const auto bytes = field.as<Binary>();
  const auto* const begin = reinterpret_cast<const Bytes::value_type*>(bytes.data());
  return {begin, begin + bytes.size()};
}
#else
using Binary = pqxx::binarystring;
[[nodiscard]] inline Binary binary(ByteView bytes) { return {bytes.data(), bytes.size()}; }
[[nodiscard]] inline Bytes bytes_of(const pqxx::field& field) {
  const Binary bytes(field);
  return {bytes.data(), bytes.data() + bytes.size()};
}
#endif

/// Takes the server's notices, which libpqxx otherwise prints, while it lives or longer.
#if PQXX_VERSION_MAJOR > 7 || (PQXX_VERSION_MAJOR == 7 && PQXX_VERSION_MINOR >= 10)
struct QuietNotices {
  explicit QuietNotices(pqxx::connection& connection) {
    connection.set_notice_handler([](pqxx::zview) noexcept {});
  }
};
#else
using QuietNotices = pqxx::quiet_errorhandler;
#endif

#if PQXX_VERSION_MAJOR >= 7
[[nodiscard]] inline pqxx::result executed(pqxx::transaction_base& work, const std::string& sql,
                                           const pqxx::params& parameters) {
#if PQXX_VERSION_MAJOR > 7 || PQXX_VERSION_MINOR >= 10
  return work.exec(sql, parameters);
#else
  return work.exec_params(sql, parameters);
#endif
}
#endif

/// Runs a statement with its parameters, $1 and following.
template <typename... Parameters>
[[nodiscard]] pqxx::result executed(pqxx::transaction_base& work, const std::string& sql,
                                    const Parameters&... parameters) {
  if constexpr (sizeof...(parameters) == 0) {
    return work.exec(sql);
  } else {
#if PQXX_VERSION_MAJOR >= 7
    return executed(work, sql, pqxx::params{parameters...});
#else
    return work.exec_params(sql, parameters...);
#endif
  }
}

/// Runs a statement whose first parameters are the texts, and whose others are the boxes.
[[nodiscard]] inline pqxx::result executed_with_lists(pqxx::transaction_base& work,
                                                      const std::string& sql,
                                                      const std::vector<std::string>& texts,
                                                      const std::vector<Binary>& boxes) {
#if PQXX_VERSION_MAJOR >= 7
  pqxx::params parameters;
  for (const std::string& text : texts) parameters.append(text);
  for (const Binary& box : boxes) parameters.append(box);
  return executed(work, sql, parameters);
#else
  return work.exec_params(sql, pqxx::prepare::make_dynamic_params(texts),
                          pqxx::prepare::make_dynamic_params(boxes));
#endif
}

}  // namespace touchtrial::collect
