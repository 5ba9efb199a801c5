/// \file The table of bundles on a server, and sending to it. Source: docs/several-stations.md,
/// docs/decisions/0042.
#pragma once

#include "core/bytes.hpp"
#include "core/errors.hpp"
#include "core/hash.hpp"
#include "record/merging/collect.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace touchtrial::merging {

/// The unencrypted index of a row. Merging does not trust it.
struct BundleRow {
  std::int64_t number = 0;  ///< assigned by the server
  std::string sent_by{};    ///< the role that added it, according to the server
  Digest station{};         ///< record::station_identity of its chain
  Digest seal{};            ///< of the study
  std::int64_t first = 0;   ///< sequence of the first event of its part of the chain
  std::int64_t end = 0;     ///< sequence after the last event
  Digest head{};            ///< hash of the last event
  std::int64_t keys = 0;    ///< number of the session's keys in it, 0 to 2

  /// "bundle 3, sent by lab_a,"
  [[nodiscard]] std::string name() const {
    return "bundle " + std::to_string(number) + ", sent by " + one_line(sent_by) + ",";
  }
  /// Whether it is the same part of the same chain.
  [[nodiscard]] bool is_same_part(const BundleRow& other) const {
    return station == other.station && first == other.first && end == other.end &&
           head == other.head;
  }
};

/// The table of bundles. Not thread-safe. Every function throws StoreError, naming the server, if
/// the connection is lost, the role lacks the right, or the answer exceeds the limits of time and
/// size.
class BundleTable {
 public:
  enum class Half { chain, session };

  virtual ~BundleTable() = default;
  /// The server's address, for messages.
  [[nodiscard]] virtual const std::string& address() const = 0;
  /// All rows; empty if there is no table.
  [[nodiscard]] virtual std::vector<BundleRow> rows() = 0;
  /// Adds a row unless it exists, and creates the table if necessary. When it returns, the row is
  /// durable on the server.
  /// \param row  number and sent_by are not read
  /// \param session  empty: the part closes no session
  virtual void add(const BundleRow& row, ByteView chain, ByteView session) = 0;
  /// One half of a row; empty if it exceeds kMaxBundleBytes, or was deleted.
  [[nodiscard]] virtual Bytes half(std::int64_t number, Half half) = 0;
};

/// Connects to the table at a postgresql:// address. Loads a module beside the program; only this
/// module needs PostgreSQL's client library.
/// \throws UsageError, without the address, if it is malformed, contains a password, or allows less
///   than TLS with a verified host name to another machine
/// \throws StoreError if module, library or server cannot be used
[[nodiscard]] std::unique_ptr<BundleTable> open_bundle_table(const std::string& address);

/// Every station whose bundles are in the table. Bundles are fetched on demand: one session is in
/// memory at a time.
/// \throws StoreError if the server cannot be read, or has no bundles
[[nodiscard]] Stations stations_of_table(std::shared_ptr<BundleTable> table);

struct SendReport {
  std::vector<std::string> sent;  ///< participants of the sessions, in the order of their ends
  std::vector<SessionLeftOut>
      left_out;           ///< sessions that have not ended, which stay at the station
  int already_there = 0;  ///< finished sessions that were already on the server
  /// Rows with keys of participants who withdrew: the table's owner should delete them.
  std::vector<std::int64_t> rows_with_erased_keys;
};

/// Sends the bundles that the table lacks, each in its own transaction. It can be interrupted at
/// any point and repeated; any number of stations may send at once.
/// \param station  with checked evidence
/// \param dry_run  only determines what would be sent and whether anything prevents it
/// \param progress  called with the number of bundles sent so far and the number to send
/// \throws StoreError, naming the server and the row, if the table contains another study, or the
///   file is an older or diverged copy of the station's file
[[nodiscard]] SendReport send_station(StationFile& station, BundleTable& table, bool dry_run,
                                      const CollectProgress& progress = {});

}  // namespace touchtrial::merging
