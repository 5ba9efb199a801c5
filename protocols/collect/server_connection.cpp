#include "protocols/collect/server_connection.hpp"

#include "protocols/collect/connection_refusal.hpp"
#include "protocols/store/damaged_store.hpp"

#include <algorithm>
#include <initializer_list>
#include <string>

namespace touchtrial::collect {
namespace {

/// SHA-256 in SQL, which arrivals are checked with, came with this version.
constexpr int kOldestServer = 110000;

/// A station that dies must not keep its locks: the server notices within a minute.
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

/// What the server says, without the statement that it then quotes and points into with a caret.
std::string complaint(const std::exception& error) {
  const std::string text = error.what();
  return without_ending(text.substr(0, text.find('\n')));
}

/// Only what will be refused again is final.
[[noreturn]] void refuse_connection(const ServerAddress& address, const std::string& why) {
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

Bytes bytes_of(const pqxx::field& field) {
  const pqxx::binarystring text(field);
  return {text.data(), text.data() + text.size()};
}

ServerConnection::ServerConnection(const ServerAddress& address)
    : address_(address), connection_(connected(address)) {
  translated([&] { check_server(); });
}

void ServerConnection::check_server() {
  // Libpqxx prints the server's remarks unless somebody else takes them.
  pqxx::quiet_errorhandler quiet(connection_);
  if (connection_.server_version() < kOldestServer) {
    refuse("the server is older than PostgreSQL 11; bring it up to date");
  }
  pqxx::nontransaction session(connection_);
  session.exec(kSettings);
  const auto encoding = session.exec1("SHOW server_encoding")[0].as<std::string>();
  if (encoding != "UTF8" && encoding != "SQL_ASCII") {
    refuse("the database's encoding is " + one_line(encoding) +
           "; make one with `createdb --encoding=UTF8 --template=template0`");
  }
}

void ServerConnection::refuse(const std::string& text) const {
  throw StoreError(address_.shown() + ": " + text);
}

std::unique_ptr<pqxx::work> ServerConnection::begin_look() {
  auto transaction = std::make_unique<pqxx::work>(connection_);
  transaction->exec("SET TRANSACTION ISOLATION LEVEL REPEATABLE READ READ ONLY");
  return transaction;
}

// A plain VACUUM leaves the bytes of a page's last row where they were.
void ServerConnection::wipe_deleted_keys() noexcept {
  try {
    pqxx::nontransaction session(connection_);
    session.exec("SET lock_timeout = '2s'");
    session.exec("VACUUM FULL participant_keys");
  } catch (const std::exception&) {
    // Everything is committed; docs/several-stations.md tells the owner to do it.
  }
}

void ServerConnection::refuse_damage(const store::EventFault& fault) const {
  // A station's file chain stands under its negative number.
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

// Of some errors libpqxx has a type and forgets the state, of others it has the state alone.
void ServerConnection::translate(const pqxx::failure& error) const {
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
