#include "protocols/collect/server_address.hpp"

#include "core/errors.hpp"
#include "core/files.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <arpa/inet.h>
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

constexpr int kConnectTimeoutS = 10;
constexpr int kLongestConnectTimeoutS = 60;

using Options = std::unique_ptr<PQconninfoOption, decltype(&PQconninfoFree)>;

Parameters given_in(const Options& options) {
  Parameters parameters;
  for (const PQconninfoOption* option = options.get();
       option != nullptr && option->keyword != nullptr; ++option) {
    if (option->val != nullptr) parameters[option->keyword] = option->val;
  }
  return parameters;
}

/// Does not pass on libpq's own complaint, which repeats the address.
Parameters parsed(const std::string& where) {
  const bool ours = where.starts_with("postgresql://") || where.starts_with("postgres://");
  char* complaint = nullptr;
  const Options options(ours ? PQconninfoParse(where.c_str(), &complaint) : nullptr,
                        PQconninfoFree);
  PQfreemem(complaint);
  if (!options) {
    throw UsageError(
        "this is no address of a PostgreSQL database; write postgresql://USER@HOST/DATABASE");
  }
  return given_in(options);
}

/// Sets a variable of the environment as long as it lives.
class Environment {
 public:
  Environment(const char* name, const std::string& value) : name_(name) {
    if (const char* const before = std::getenv(name)) before_ = before;
    ::setenv(name, value.c_str(), 1);
  }
  ~Environment() {
    if (before_) {
      ::setenv(name_, before_->c_str(), 1);
    } else {
      ::unsetenv(name_);
    }
  }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

/// What libpq adds to an address: the service file's settings, then those of the environment, then
/// its own. Its function for that knows a service by PGSERVICE alone.
Parameters added_to(const Parameters& address) {
  std::optional<Environment> service;
  if (const auto named = address.find("service"); named != address.end()) {
    service.emplace("PGSERVICE", named->second);
  }
  return given_in(Options(PQconndefaults(), PQconninfoFree));
}

std::vector<std::string> parts_of(const std::string& list) {
  std::vector<std::string> parts(1);
  for (const char character : list) {
    if (character == ',') {
      parts.emplace_back();
    } else {
      parts.back() += character;
    }
  }
  return parts;
}

bool is_loopback(const std::string& number) {
  in_addr four{};
  if (inet_pton(AF_INET, number.c_str(), &four) == 1) return (ntohl(four.s_addr) >> 24U) == 127;
  in6_addr six{};
  return inet_pton(AF_INET6, number.c_str(), &six) == 1 && IN6_IS_ADDR_LOOPBACK(&six);
}

/// \param host  a name, a number, or the folder of a socket; empty: libpq's own socket
bool is_this_machine(const std::string& host) {
  return host.empty() || host.front() == '/' || host.front() == '@' || host == "localhost" ||
         is_loopback(host);
}

/// Of several servers libpq takes any that answers, so each must be local. Where a number is given
/// (hostaddr), libpq connects to that, and uses the name (host) for the certificate alone.
bool all_local(const Parameters& parameters) {
  const auto value = [&](const char* name) {
    const auto found = parameters.find(name);
    return found == parameters.end() ? std::string() : found->second;
  };
  const std::vector<std::string> hosts = parts_of(value("host"));
  const std::vector<std::string> numbers = parts_of(value("hostaddr"));
  for (std::size_t i = 0; i < std::max(hosts.size(), numbers.size()); ++i) {
    const std::string number = i < numbers.size() ? numbers[i] : "";
    const std::string host = i < hosts.size() ? hosts[i] : "";
    if (number.empty() ? !is_this_machine(host) : !is_loopback(number)) return false;
  }
  return true;
}

/// Says so explicitly: what an address says comes before service file and environment.
void require_proof_of_name(Parameters& address) {
  const auto [mode, mode_is_new] = address.emplace("sslmode", "verify-full");
  if (mode->second != "verify-full") {
    throw UsageError(
        "the address asks for less than sslmode=verify-full to another machine, so that anybody in "
        "between could read and alter the study; write ?sslmode=verify-full, and "
        "&sslrootcert=FILE with the certificate of the authority that signed the server's");
  }
  // Encryption by GSSAPI would come first, and in place of TLS.
  const auto [gss, gss_is_new] = address.emplace("gssencmode", "disable");
  if (gss->second != "disable") {
    throw UsageError(
        "the address asks for encryption by GSSAPI, in whose place Touchtrial uses TLS with "
        "sslmode=verify-full; take gssencmode out");
  }
}

/// libpq would wait for ever where this is 0 or no number.
void bound_connect_timeout(Parameters& address, const Parameters& added) {
  const auto in_address = address.find("connect_timeout");
  const auto in_added = added.find("connect_timeout");
  const std::string given = in_address != address.end() ? in_address->second
                            : in_added != added.end()   ? in_added->second
                                                        : "";
  int seconds = 0;
  const char* const end = given.data() + given.size();
  const auto [stop, error] = std::from_chars(given.data(), end, seconds);
  if (error != std::errc{} || stop != end || seconds < 1) seconds = kConnectTimeoutS;
  address["connect_timeout"] = std::to_string(std::min(seconds, kLongestConnectTimeoutS));
}

/// libpq would ignore such a file of passwords with a warning of its own, and read such a service
/// file.
void refuse_open_secrets(const Parameters& address, const Parameters& added) {
  namespace fs = std::filesystem;
  const char* const home = std::getenv("HOME");
  const auto own = [&](const char* name) {
    return home == nullptr ? fs::path() : fs::path(home) / name;
  };
  const auto file = [&](const char* name, const Parameters& source) {
    const auto found = source.find(name);
    return found == source.end() ? fs::path() : fs::path(found->second);
  };
  fs::path passwords = file("passfile", address);
  if (passwords.empty()) passwords = file("passfile", added);
  if (passwords.empty()) passwords = own(".pgpass");
  std::error_code none;
  if (fs::is_regular_file(passwords, none)) require_owner_only(passwords);

  const char* const named = std::getenv("PGSERVICEFILE");
  const fs::path services = named == nullptr ? own(".pg_service.conf") : fs::path(named);
  if (!fs::is_regular_file(services, none)) return;
  std::ifstream lines(services);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("password") || line.starts_with("sslpassword")) {
      return require_owner_only(services);
    }
  }
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
  const Parameters added = added_to(parameters);
  refuse_open_secrets(parameters, added);
  for (const auto& [name, value] : kDefaults) parameters.emplace(name, value);
  bound_connect_timeout(parameters, added);
  // As read now: files and environment could change before libpq reads them.
  for (const char* const name : {"host", "hostaddr"}) {
    if (const auto found = added.find(name); found != added.end() && !found->second.empty()) {
      parameters.emplace(name, found->second);
    }
  }
  is_local_ = all_local(parameters);
  if (!is_local_) require_proof_of_name(parameters);
  connection_ = joined(parameters);
}

}  // namespace touchtrial::collect
