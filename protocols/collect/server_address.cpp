#include "protocols/collect/server_address.hpp"

#include "core/errors.hpp"

#include <array>
#include <cstdlib>
#include <map>
#include <memory>
#include <utility>

#include <libpq-fe.h>

namespace touchtrial::collect {
namespace {

using Parameters = std::map<std::string, std::string>;

/// Settings that hold unless the address says otherwise. With them an unreachable server or a
/// pulled cable is noticed within about half a minute.
constexpr std::array<std::pair<const char*, const char*>, 6> kDefaults = {{
    {"fallback_application_name", "touchtrial"},
    {"keepalives_idle", "15"},
    {"keepalives_interval", "5"},
    {"keepalives_count", "3"},
    {"tcp_user_timeout", "30000"},
    {"client_encoding", "UTF8"},
}};

/// Does not pass on libpq's own complaint, which repeats the address.
Parameters parsed(const std::string& where) {
  const bool ours = where.starts_with("postgresql://") || where.starts_with("postgres://");
  using Options = std::unique_ptr<PQconninfoOption, decltype(&PQconninfoFree)>;
  char* complaint = nullptr;
  const Options options(ours ? PQconninfoParse(where.c_str(), &complaint) : nullptr,
                        PQconninfoFree);
  PQfreemem(complaint);
  if (!options) {
    throw UsageError(
        "this is no address of a PostgreSQL database; write postgresql://USER@HOST/DATABASE");
  }
  Parameters parameters;
  for (const PQconninfoOption* option = options.get(); option->keyword != nullptr; ++option) {
    if (option->val != nullptr) parameters[option->keyword] = option->val;
  }
  return parameters;
}

void refuse_passwords(const Parameters& parameters) {
  for (const char* const name : {"password", "sslpassword"}) {
    if (!parameters.contains(name)) continue;
    throw UsageError(
        "the address holds a password, which every user of this machine can read in the list of "
        "programs; take it out and change it, and lay it in ~/.pgpass, PGPASSWORD or a service "
        "file");
  }
}

/// A value for libpq: in single quotes, with quotes and backslashes escaped.
std::string quoted(const std::string& value) {
  std::string text = "'";
  for (const char character : value) {
    if (character == '\'' || character == '\\') text += '\\';
    text += character;
  }
  return text + "'";
}

std::string joined(const Parameters& parameters) {
  std::string text;
  for (const auto& [name, value] : parameters) text += name + "=" + quoted(value) + " ";
  return text;
}

std::string value_of(const Parameters& parameters, const char* name, const char* variable) {
  const auto found = parameters.find(name);
  if (found != parameters.end()) return found->second;
  const char* const value = std::getenv(variable);
  return value == nullptr ? "" : value;
}

std::string shown_of(const Parameters& parameters) {
  const std::string service = value_of(parameters, "service", "PGSERVICE");
  const std::string host = value_of(parameters, "host", "PGHOST");
  const std::string port = value_of(parameters, "port", "PGPORT");
  const std::string database = value_of(parameters, "dbname", "PGDATABASE");
  std::string text = "postgresql://" + (host.starts_with('/') ? "" : host);
  if (!port.empty()) text += ":" + port;
  text += "/" + database;
  if (host.starts_with('/')) text += "?host=" + host;
  if (host.empty() && !service.empty()) text += "?service=" + service;
  return one_line(text);
}

}  // namespace

bool is_address(std::string_view where) {
  return where.find("://") != std::string_view::npos;
}

ServerAddress::ServerAddress(const std::string& where) {
  Parameters parameters = parsed(where);
  refuse_passwords(parameters);
  shown_ = shown_of(parameters);
  for (const auto& [name, value] : kDefaults) parameters.emplace(name, value);
  // libpq also reads a setting of the environment that is empty.
  if (std::getenv("PGCONNECT_TIMEOUT") == nullptr) parameters.emplace("connect_timeout", "10");
  connection_ = joined(parameters);
}

}  // namespace touchtrial::collect
