#include "record/collected_draft.hpp"

#include "core/draft.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "record/file_chain.hpp"
#include "record/payload_json.hpp"
#include "record/rows.hpp"
#include "record/schema.hpp"

#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace touchtrial::record {
namespace {

[[noreturn]] void refuse_existing(const std::filesystem::path& path) {
  throw StoreError(one_line(path.string()) + ": exists already; choose another name");
}

}  // namespace

struct CollectedDraft::Impl {
  Impl(std::unique_ptr<Draft> folder, Database empty, std::filesystem::path path)
      : draft(std::move(folder)), database(std::move(empty)), target(std::move(path)) {
    make_tables(database);
    database.run([&] { database.write_unsynced(); });
  }

  void insert_chain(int number, const StationChain& station) {
    for (Event event : station.events) {
      event.session = -number;
      event.renumbered_from = 0;
      insert_event(database, event);
    }
  }

  /// Sessions on a screen and sessions with a haptic device are never pooled.
  void refuse_mixed_displays(const Event& opened) {
    const SessionOpening opening = body_of<SessionOpening>(opened);
    const bool is_visual = opening.is_visual();
    if (visual.value_or(is_visual) != is_visual) {
      throw StoreError("session " + std::to_string(opened.own_session()) + " is " +
                       (is_visual ? "shown on a screen, and others are felt"
                                  : "felt, and others are shown on a screen") +
                       ": they are never pooled; collect them separately");
    }
    visual = is_visual;
  }

  [[nodiscard]] static Event renumbered(int number, const Event& event) {
    Event copy = event;
    copy.session = number;
    if (event.session != number) copy.renumbered_from = event.session;
    return copy;
  }

  /// Calls `work`; faults of the current session are rethrown with its number at the station.
  template <typename Work>
  void with_station_numbers(Work&& work) const {
    try {
      work();
    } catch (const EventFault& fault) {
      const int own_session = chain.sessions.at(static_cast<std::size_t>(session) - 1).own_session;
      throw EventFault(fault.session() == session ? own_session : fault.session(), fault.sequence(),
                       fault.description());
    }
  }

  std::unique_ptr<Draft> draft;  ///< must outlive the database in it
  Database database;
  std::filesystem::path target;
  CollectedChain chain;
  FileChain on_file{UniquePlaces::at_end};
  std::optional<bool> visual;
  int session = 0;  ///< number of the session added last
  std::map<int, TraceClaim> claims;
};

CollectedDraft::CollectedDraft(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
CollectedDraft::~CollectedDraft() = default;
CollectedDraft::CollectedDraft(CollectedDraft&&) noexcept = default;

CollectedDraft CollectedDraft::in_file(const std::filesystem::path& target) {
  refuse_link(target);
  if (path_exists(target)) refuse_existing(target);
  auto draft = std::make_unique<Draft>(target, Draft::Kind::folder);
  Database database = Database::create(draft->path() / target.filename());
  return CollectedDraft(std::make_unique<Impl>(std::move(draft), std::move(database), target));
}

const CollectedChain& CollectedDraft::begin(std::span<const StationChain> stations) {
  impl_->chain = collected_chain(stations);
  for (const Event& event : impl_->chain.events) impl_->on_file.add(event);
  impl_->database.change([&] {
    // Events are inserted in key order, so that the table grows only at its end.
    for (int number = static_cast<int>(stations.size()); number > 0; --number) {
      impl_->insert_chain(number, stations[static_cast<std::size_t>(number) - 1]);
    }
    for (const Event& event : impl_->chain.events) insert_event(impl_->database, event);
  });
  return impl_->chain;
}

void CollectedDraft::add_session(int session, std::span<const Event> events,
                                 const WrappedKeys& keys) {
  impl_->session = session;
  const SessionOnFile& on_file = impl_->on_file.sessions().at(session);
  SessionCheck check(session, on_file, *impl_->on_file.commitment());
  DerivedRows rows;
  std::vector<Event> renumbered;
  impl_->with_station_numbers([&] {
    for (const Event& event : events) {
      renumbered.push_back(impl_->renumbered(session, event));
      check.add(renumbered.back(), rows);
    }
    check.finish(rows);
    check.check_keys(keys);
    impl_->refuse_mixed_displays(renumbered.front());
  });
  impl_->claims = check.claims();
  impl_->database.change([&] {
    for (const Event& event : renumbered) insert_event(impl_->database, event);
    insert_keys(impl_->database, session, keys);
  });
}

void CollectedDraft::add_trace(int trial, const Bytes& box) {
  impl_->with_station_numbers([&] {
    const auto claim = impl_->claims.find(trial);
    const std::string name = "trace of trial " + std::to_string(trial);
    if (claim == impl_->claims.end()) {
      throw EventFault(impl_->session, kNoEvent,
                       name + " has no event, or occurs twice [stray-trace]");
    }
    if (blake2b(box) != claim->second.digest) {
      throw EventFault(impl_->session, claim->second.sequence,
                       name + " was altered [altered-trace]");
    }
    impl_->claims.erase(claim);
  });
  impl_->database.run([&] {
    insert_trace(impl_->database, {.session = impl_->session, .trial = trial, .box = box});
  });
}

void CollectedDraft::end_traces() const {
  if (impl_->claims.empty()) return;
  impl_->with_station_numbers([&] {
    const auto& [trial, claim] = *impl_->claims.begin();
    throw EventFault(impl_->session, claim.sequence,
                     "trace of trial " + std::to_string(trial) + " is missing [missing-trace]");
  });
}

void CollectedDraft::finish() && {
  impl_->database.run([&] { impl_->database.write_safely(); });
  const std::filesystem::path target = impl_->target;
  const std::unique_ptr<Draft> draft = std::move(impl_->draft);
  impl_.reset();  // closes it, so that no journal is left beside it
  if (!move_to_free_name(draft->path() / target.filename(), target)) refuse_existing(target);
}

}  // namespace touchtrial::record
