#include "protocols/collect/server_connection.hpp"

#include "protocols/store/damage.hpp"

#include <algorithm>
#include <chrono>
#include <initializer_list>
#include <string>
#include <string_view>

#include <libpq-fe.h>
#include <poll.h>

namespace touchtrial::collect {
namespace {

/// The first version with SHA-256 in SQL, which the checks of arrivals need.
constexpr int kOldestServer = 110000;

/// With the keepalives the server notices within a minute that a station died, and frees its locks.
constexpr const char* kSettings =
    "SET synchronous_commit = on; SET bytea_output = 'hex'; SET lock_timeout = '60s'; "
    "SET statement_timeout = 0; "
    "SET tcp_keepalives_idle = 30; "
    "SET tcp_keepalives_interval = 10; SET tcp_keepalives_count = 3; "
    "SET extra_float_digits = 1; SET client_min_messages = error";

std::string without_ending(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  text = one_line(text);
  const auto both_spaces = [](char a, char b) { return a == ' ' && b == ' '; };
  text.erase(std::unique(text.begin(), text.end(), both_spaces), text.end());
  return text;
}

/// The server's message without the lines that quote the statement and point into it.
std::string complaint(const std::exception& error) {
  const std::string text = error.what();
  return without_ending(text.substr(0, text.find('\n')));
}

/// Why a server did not let somebody in.
enum class ConnectionRefusal {
  unreached,    ///< no answer, a broken handshake, or a server that starts or stops
  too_many,     ///< too many connections in all or of this role
  credentials,  ///< user, password, database or rights: the server will refuse them again
};

constexpr std::chrono::seconds kLongestAttempt{10};

using Connection = std::unique_ptr<PGconn, decltype(&PQfinish)>;

/// Returns when the connection stands, has failed, or the time is over.
void establish(PGconn* connection) {
  const auto end = std::chrono::steady_clock::now() + kLongestAttempt;
  PostgresPollingStatusType next = PGRES_POLLING_WRITING;
  while (next == PGRES_POLLING_READING || next == PGRES_POLLING_WRITING) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        end - std::chrono::steady_clock::now());
    if (left.count() <= 0) return;
    const auto events = static_cast<short>(next == PGRES_POLLING_READING ? POLLIN : POLLOUT);
    pollfd socket{.fd = PQsocket(connection), .events = events, .revents = 0};
    if (poll(&socket, 1, static_cast<int>(left.count())) <= 0) return;
    next = PQconnectPoll(connection);
  }
}

/// The server's code at the end of a line, for instance of "FATAL: 28P01"; empty for libpq's own
/// lines.
std::string code_at_end(std::string_view line) {
  while (line.ends_with(' ')) line.remove_suffix(1);
  if (line.size() < 6 || line[line.size() - 6] != ' ') return {};
  const std::string code(line.substr(line.size() - 5));
  const bool is_code = std::all_of(code.begin(), code.end(), [](char each) {
    return (each >= '0' && each <= '9') || (each >= 'A' && each <= 'Z');
  });
  return is_code ? code : "";
}

/// The code of the last of several servers; libpq may add lines of its own.
std::string code_in(std::string_view text) {
  std::string code;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string found = code_at_end(text.substr(0, end));
    if (!found.empty()) code = found;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return code;
}

/// Connects once more: an error of libpqxx lacks the server's code, and its words may be in any
/// language. Takes as long as the address' connect_timeout allows.
/// \return unreached also if it succeeds now
ConnectionRefusal refusal_by(const ServerAddress& address) {
  const Connection connection(PQconnectStart(address.connection_string().c_str()), PQfinish);
  if (!connection) return ConnectionRefusal::unreached;
  PQsetErrorVerbosity(connection.get(), PQERRORS_SQLSTATE);
  if (PQstatus(connection.get()) != CONNECTION_BAD) establish(connection.get());
  if (PQstatus(connection.get()) == CONNECTION_OK) return ConnectionRefusal::unreached;
  if (PQconnectionNeedsPassword(connection.get()) != 0) return ConnectionRefusal::credentials;
  const std::string code = code_in(PQerrorMessage(connection.get()));
  if (code == "53300") return ConnectionRefusal::too_many;
  const bool is_final = code.starts_with("28") || code == "3D000" || code == "42501";
  return is_final ? ConnectionRefusal::credentials : ConnectionRefusal::unreached;
}

/// Whether libpq complains of the server's certificate, or that it has none. Its own messages are
/// in English here: the program sets no locale.
bool is_about_certificate(std::string_view why) {
  return why.find("certificate") != std::string_view::npos ||
         why.find("SSL") != std::string_view::npos ||
         why.find("host name") != std::string_view::npos;
}

/// Only a refusal that will come again is final; all others are a LostConnection.
[[noreturn]] void refuse_connection(const ServerAddress& address, const std::string& why) {
  if (!address.is_local() && is_about_certificate(why)) {
    throw StoreError(
        address.shown() + ": the server does not prove its name: " + without_ending(why) +
        "; have TLS set up on the server, write its address as the certificate has it, "
        "and give the certificate of the authority that signed it as "
        "~/.postgresql/root.crt or with ?sslrootcert=FILE");
  }
  switch (refusal_by(address)) {
    case ConnectionRefusal::credentials:
      throw StoreError(address.shown() + ": the server refuses: " + without_ending(why) +
                       "; check user, database and password (~/.pgpass, PGPASSWORD)");
    case ConnectionRefusal::too_many:
      throw LostConnection(address.shown() + ": the server is busy: " + without_ending(why) +
                           "; try again later, or have its max_connections or the role's "
                           "CONNECTION LIMIT raised");
    case ConnectionRefusal::unreached:
      break;
  }
  throw LostConnection(address.shown() + ": cannot be reached: " + without_ending(why) +
                       "; check the address, and that the server runs");
}

pqxx::connection connected(const ServerAddress& address) {
  try {
    return pqxx::connection(address.connection_string());
  } catch (const pqxx::failure& error) {
    refuse_connection(address, error.what());
  }
}

template <typename Type>
bool is_a(const pqxx::failure& error) {
  return dynamic_cast<const Type*>(&error) != nullptr;
}

}  // namespace

ServerConnection::ServerConnection(const ServerAddress& address, const AnswerLimits& limits)
    : address_(address), connection_(connected(address)), watch_(connection_.sock(), limits) {
  translated([&] { check_server(); });
}

void ServerConnection::check_server() {
  const QuietNotices quiet(connection_);
  if (connection_.server_version() < kOldestServer) {
    refuse("the server is older than PostgreSQL 11; bring it up to date");
  }
  const AnswerWatch::Waiting waiting(watch_);
  pqxx::nontransaction session(connection_);
  session.exec(kSettings);
  const auto encoding = session.exec("SHOW server_encoding").at(0)[0].as<std::string>();
  if (encoding != "UTF8" && encoding != "SQL_ASCII") {
    refuse("the database's encoding is " + one_line(encoding) +
           "; make one with `createdb --encoding=UTF8 --template=template0`");
  }
}

void ServerConnection::refuse(const std::string& text) const {
  throw StoreError(address_.shown() + ": " + text);
}

std::unique_ptr<ServerWork> ServerConnection::begin_look() {
  auto transaction = std::make_unique<ServerWork>(connection_, watch_);
  transaction->exec("SET TRANSACTION ISOLATION LEVEL REPEATABLE READ READ ONLY");
  return transaction;
}

// A plain VACUUM leaves the bytes of a page's last row where they were.
bool ServerConnection::wipe_deleted_keys() noexcept {
  try {
    const AnswerWatch::Waiting waiting(watch_);
    pqxx::nontransaction session(connection_);
    session.exec("SET lock_timeout = '2s'");
    // For anybody else VACUUM warns and does nothing.
    const bool is_owner = session
                              .exec(
                                  "SELECT pg_has_role(relowner, 'USAGE') FROM pg_class WHERE "
                                  "oid = 'participant_keys'::regclass")
                              .at(0)[0]
                              .as<bool>();
    if (is_owner) session.exec("VACUUM FULL participant_keys, safety_keys");
    return is_owner;
  } catch (const std::exception&) {
    // Everything is committed. docs/several-stations.md tells the owner how to wipe the table.
    return false;
  }
}

void ServerConnection::refuse_damage(const store::EventFault& fault) const {
  // A station's file chain is stored under the station's negative number.
  const auto known = places_.find(static_cast<int>(fault.session()));
  const std::string place = known != places_.end() ? known->second
                            : fault.session() < 0
                                ? "station " + std::to_string(-fault.session()) + ", file chain"
                                : "session " + std::to_string(fault.session()) + " of the server";
  throw store::DamagedStore(
      address_.shown() + ": " + place +
      (fault.sequence() < 0 ? "" : ", event " + std::to_string(fault.sequence())) + ": " +
      fault.bare() + "; restore the database from a backup");
}

void ServerConnection::refuse_garbage(const std::string& what) const {
  throw store::DamagedStore(address_.shown() + ": holds what Touchtrial did not write (" +
                            without_ending(what) + "); restore the database from a backup");
}

// For some errors libpqxx has a type and drops the state; for others it has the state alone.
void ServerConnection::translate(const pqxx::failure& error) const {
  if (const std::string reason = watch_.reason(); !reason.empty()) refuse(reason);
  const auto* const sql = dynamic_cast<const pqxx::sql_error*>(&error);
  const std::string state = sql == nullptr ? "" : sql->sqlstate();
  const auto state_is = [&](std::initializer_list<const char*> states) {
    return std::any_of(states.begin(), states.end(),
                       [&](const char* each) { return state.starts_with(each); });
  };
  if (is_a<pqxx::broken_connection>(error) || is_a<pqxx::in_doubt_error>(error) ||
      is_a<pqxx::statement_completion_unknown>(error) ||
      state_is({"08", "57P01", "57P02", "57P03", "57P05", "25P03"}) || !connection_.is_open()) {
    throw LostConnection(address_.shown() + ": the connection was lost");
  }
  if (is_a<pqxx::transaction_rollback>(error) || is_a<pqxx::unique_violation>(error) ||
      state_is({"55P03"})) {
    throw Contention(address_.shown() + ": others are writing the same: " + complaint(error));
  }
  if (is_a<pqxx::insufficient_privilege>(error)) {
    refuse(complaint(error) +
           "; ask whoever keeps the server for the rights that docs/several-stations.md lists");
  }
  if (is_a<pqxx::undefined_table>(error) || is_a<pqxx::undefined_column>(error) ||
      is_a<pqxx::undefined_function>(error) || state_is({"42P01", "42703", "42883"})) {
    throw store::DamagedStore(
        address_.shown() + ": lacks what Touchtrial made there (" + complaint(error) +
        "); restore the database from a backup, or make a new one and sync all "
        "stations again");
  }
  if (state_is({"25006"})) {
    refuse("the database is read-only (" + complaint(error) +
           "); give the address of the server that takes writes, or have "
           "default_transaction_read_only switched off");
  }
  if (state_is({"57014"})) {
    refuse("the server broke off a statement (" + complaint(error) +
           "); run the same command again, or ask whoever keeps the server for more time");
  }
  if (is_a<pqxx::disk_full>(error)) {
    refuse("the server's disk is full; make room there and try again");
  }
  refuse(complaint(error) + "; run the same command again, or ask whoever keeps the server");
}

}  // namespace touchtrial::collect
