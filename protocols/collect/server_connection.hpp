/// \file One connection to a PostgreSQL server, and its errors. Private to protocols/collect.
#pragma once

#include "core/bytes.hpp"
#include "core/errors.hpp"
#include "protocols/collect/answer_watch.hpp"
#include "protocols/collect/libpqxx_calls.hpp"
#include "protocols/collect/server_address.hpp"
#include "protocols/store/damage.hpp"

#include <exception>
#include <map>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <pqxx/pqxx>

namespace touchtrial::collect {

/// The connection broke or the server went away. Uncommitted changes are lost; a commit that was
/// under way may have taken place. Trying again on a new connection may help.
class LostConnection : public StoreError {
 public:
  using StoreError::StoreError;
};

/// Another program wrote the same rows. Nothing was changed, and trying again helps.
class Contention : public StoreError {
 public:
  using StoreError::StoreError;
};

/// A transaction whose answers are watched. Rolls back unless it was committed.
class ServerWork {
 public:
  ServerWork(pqxx::connection& connection, AnswerWatch& watch) : watch_(watch), work_(connection) {}
  ~ServerWork() {
    if (committed_) return;
    try {
      const AnswerWatch::Waiting waiting(watch_);
      work_.abort();
    } catch (const std::exception&) {
      // The connection is gone, and the transaction with it.
    }
  }
  ServerWork(const ServerWork&) = delete;
  ServerWork& operator=(const ServerWork&) = delete;

  /// Runs a statement with its parameters, $1 and following.
  template <typename... Parameters>
  pqxx::result exec(const std::string& sql, const Parameters&... parameters) {
    const AnswerWatch::Waiting waiting(watch_);
    return executed(work_, sql, parameters...);
  }
  /// \return the only row
  /// \throws pqxx::unexpected_rows if there are none or several
  template <typename... Parameters>
  pqxx::row exec1(const std::string& sql, const Parameters&... parameters) {
    const pqxx::result rows = exec(sql, parameters...);
    require_rows(rows, 1);
    return rows[0];
  }
  /// \throws pqxx::unexpected_rows if there is a row
  template <typename... Parameters>
  void exec0(const std::string& sql, const Parameters&... parameters) {
    require_rows(exec(sql, parameters...), 0);
  }
  /// Like exec0; the first parameters are the texts, the others the boxes.
  void exec0_with_lists(const std::string& sql, const std::vector<std::string>& texts,
                        const std::vector<Binary>& boxes) {
    const AnswerWatch::Waiting waiting(watch_);
    require_rows(executed_with_lists(work_, sql, texts, boxes), 0);
  }
  void commit() {
    const AnswerWatch::Waiting waiting(watch_);
    committed_ = true;  // or ended otherwise, if this throws
    work_.commit();
  }

 private:
  static void require_rows(const pqxx::result& rows, pqxx::result::size_type count) {
    if (rows.size() == count) return;
    throw pqxx::unexpected_rows("expected " + std::to_string(count) + " row(s), got " +
                                std::to_string(rows.size()));
  }

  AnswerWatch& watch_;
  pqxx::work work_;
  bool committed_ = false;
};

/// Not to be shared between threads.
class ServerConnection {
 public:
  /// \throws LostConnection if the server cannot be reached or is starting up
  /// \throws StoreError if it is there and refuses (password, database, version, encoding), does
  ///   not prove its name, or passes the limits
  explicit ServerConnection(const ServerAddress& address, const AnswerLimits& limits = {});

  [[nodiscard]] const ServerAddress& address() const noexcept { return address_; }

  /// Names a session for messages about damage from now on.
  /// \param session  the number on the server; for a station's file chain its negative number
  void call(int session, const std::string& place) { places_[session] = place; }

  /// Calls `work` with a transaction, which is committed unless `work` throws.
  template <typename Work>
  auto change(Work&& work) {
    return translated([&] {
      ServerWork transaction(connection_, watch_);
      // A program that hangs must not keep others waiting forever.
      transaction.exec("SET LOCAL idle_in_transaction_session_timeout = '5min'");
      if constexpr (std::is_void_v<decltype(work(transaction))>) {
        work(transaction);
        transaction.commit();
      } else {
        auto result = work(transaction);
        transaction.commit();
        return result;
      }
    });
  }

  /// Calls `work` with a transaction that sees one moment and changes nothing.
  template <typename Work>
  auto look(Work&& work) {
    return translated([&] {
      const std::unique_ptr<ServerWork> transaction = begin_look();
      return work(*transaction);
    });
  }

  /// A transaction that sees this moment as long as it lives, and changes nothing. Use it inside
  /// `translated`; it must not outlive the connection.
  [[nodiscard]] std::unique_ptr<ServerWork> begin_look();

  /// Rewrites the table of keys, so that deleted keys are no longer in its file. Only the table's
  /// owner may do that; for everybody else this does nothing.
  /// \return whether it was done
  bool wipe_deleted_keys() noexcept;

  /// \throws StoreError "<address>: <text>"
  [[noreturn]] void refuse(const std::string& text) const;

  /// Calls `work`; errors of libpqxx, and of rows that cannot be true, come out as our errors with
  /// the address.
  template <typename Work>
  decltype(auto) translated(Work&& work) const {
    try {
      return work();
    } catch (const store::EventFault& fault) {
      refuse_damage(fault);
    } catch (const pqxx::failure& error) {
      translate(error);
    } catch (const pqxx::conversion_error& error) {
      refuse_garbage(error.what());
    } catch (const pqxx::range_error& error) {
      refuse_garbage(error.what());
    }
  }

 private:
  [[noreturn]] void translate(const pqxx::failure& error) const;
  [[noreturn]] void refuse_damage(const store::EventFault& fault) const;
  [[noreturn]] void refuse_garbage(const std::string& what) const;
  void check_server();

  ServerAddress address_;
  std::map<int, std::string> places_;
  pqxx::connection connection_;
  AnswerWatch watch_;
};

}  // namespace touchtrial::collect
