// Stations whose bundles are on a server.
#include "record/collected_chain.hpp"
#include "record/damage.hpp"
#include "record/file_chain.hpp"
#include "record/merging/bundle.hpp"
#include "record/merging/bundle_table.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::merging {
namespace {

/// The limit for all chains of a table, which are in memory at once. A participant takes about 2
/// KiB.
constexpr std::size_t kMaxChainBytes = std::size_t{256} << 20U;

/// A table, and the memory used by all its stations.
struct Source {
  std::shared_ptr<BundleTable> table;
  std::size_t chain_bytes = 0;
  std::int64_t loaded_bundle = 0;  ///< number of the bundle that contains `session`
  BundleHalf session{};
};

class BundleStation final : public StationFile {
 public:
  /// \param rows  the station's
  BundleStation(std::shared_ptr<Source> source, std::vector<BundleRow> rows)
      : source_(std::move(source)), rows_(std::move(rows)) {
    std::ranges::sort(rows_, {},
                      [](const BundleRow& row) { return std::pair(row.first, row.end); });
    name_ = fmt::format("{}, station of {}", source_->table->address(), rows_.front().name());
  }

  [[nodiscard]] const std::string& name() const override { return name_; }

  [[nodiscard]] std::vector<record::Event> file_chain() override {
    std::vector<record::Event> chain;
    for (const BundleRow& row : rows_) extend(chain, row);
    if (record::station_identity(chain) != rows_.front().station) {
      refuse(rows_.front(), "belongs to a station other than its row states");
    }
    chain_state_ = record::FileChain();
    for (const record::Event& event : chain) chain_state_.add(event);
    return chain;
  }

  [[nodiscard]] std::vector<record::Event> events(int own_session) override {
    return session(own_session).events;
  }

  /// Omits keys that were destroyed later, because a bundle may have been sent before the
  /// participant withdrew.
  [[nodiscard]] record::WrappedKeys wrapped_keys(int own_session) override {
    record::WrappedKeys keys = session(own_session).keys;
    const record::SessionOnFile& on_file = chain_state_.sessions().at(own_session);
    if (on_file.erased_at) keys.participant.reset();
    if (on_file.safety_erased_at) keys.safety.reset();
    return keys;
  }

  void for_each_trace(int own_session,
                      const std::function<void(int, const Bytes&)>& visit) override {
    for (const auto& [trial, box] : session(own_session).traces) visit(trial, box);
  }

 private:
  [[noreturn]] void refuse(const BundleRow& row, const std::string& what) const {
    throw record::DamagedStore(
        fmt::format("{}: {} {}; ask the table's owner to delete that row, and sync its station "
                    "again",
                    source_->table->address(), row.name(), what));
  }

  [[nodiscard]] BundleHalf fetch(const BundleRow& row, BundleTable::Half half,
                                 int own_session) const {
    const Bytes bytes = source_->table->half(row.number, half);
    try {
      return unpack_bundle(bytes, own_session);
    } catch (const StoreError& error) {
      refuse(row, error.what());
    }
  }

  /// Appends the events of the row's part that are not yet in the chain. Parts overlap if the end
  /// of the chain was sent before a session ended.
  void extend(std::vector<record::Event>& chain, const BundleRow& row) const {
    std::vector<record::Event> part = fetch(row, BundleTable::Half::chain, 0).events;
    if (part.empty() || row.end - row.first != std::ssize(part) || part.back().hash != row.head) {
      refuse(row, "does not match its row");
    }
    if (row.first < 0 || row.first > std::ssize(chain)) {
      refuse(row, fmt::format("begins at event {} of its station's chain, but the chain's events "
                              "from {} on are missing",
                              row.first, chain.size()));
    }
    auto place = static_cast<std::size_t>(row.first);
    for (record::Event& event : part) {
      if (place < chain.size() && chain[place].hash != event.hash) {
        refuse(row, fmt::format("has another event {} of its station's chain than earlier bundles: "
                                "two copies of the station's file were continued separately",
                                place));
      }
      if (place++ < chain.size()) continue;
      source_->chain_bytes += sizeof event + event.body.size() + event.sealed.size();
      if (source_->chain_bytes > kMaxChainBytes)
        refuse(row, "makes the chains longer than 256 MiB");
      chain.push_back(std::move(event));
    }
  }

  /// The session, from a row that contains its closing event. Of several such rows, the one with
  /// the most keys is used; the chain decides which keys are valid.
  const BundleHalf& session(int own_session) {
    const auto closed_at = chain_state_.sessions().at(own_session).closed_at;
    const BundleRow* best = nullptr;
    for (const BundleRow& row : rows_) {
      if (!closed_at || row.end != *closed_at + 1) continue;
      if (best == nullptr || row.keys > best->keys) best = &row;
    }
    if (best == nullptr) throw record::EventFault(own_session, record::kNoEvent, "is missing");
    if (source_->loaded_bundle != best->number) {
      source_->session = fetch(*best, BundleTable::Half::session, own_session);
      source_->loaded_bundle = best->number;
    }
    return source_->session;
  }

  std::shared_ptr<Source> source_;
  std::vector<BundleRow> rows_;
  std::string name_;
  record::FileChain chain_state_;
};

}  // namespace

Stations stations_of_table(std::shared_ptr<BundleTable> table) {
  const auto source = std::make_shared<Source>(Source{.table = std::move(table)});
  std::map<Digest, std::vector<BundleRow>> by_station;
  for (BundleRow& row : source->table->rows()) by_station[row.station].push_back(std::move(row));
  if (by_station.empty()) {
    throw StoreError(source->table->address() +
                     ": contains no study yet; send one with `touchtrial sync`");
  }
  Stations stations;
  for (auto& [identity, rows] : by_station) {
    stations.push_back(std::make_unique<BundleStation>(source, std::move(rows)));
  }
  return stations;
}

}  // namespace touchtrial::merging
