#include "record/study_store.hpp"

#include "core/draft.hpp"
#include "core/files.hpp"
#include "core/outputs.hpp"
#include "record/damage.hpp"
#include "record/payload_json.hpp"
#include "record/rows.hpp"
#include "record/schema.hpp"
#include "record/stored_study.hpp"

#include <algorithm>
#include <system_error>
#include <utility>

namespace touchtrial::record {
namespace {

[[noreturn]] void refuse_existing_database(const std::filesystem::path& path) {
  throw StoreError(one_line(path.string()) +
                   ": already exists; choose another name or continue with it");
}

void check_tables(const Database& database) {
  for (const char* const table : kTables) {
    if (database.connection().tableExists(table)) continue;
    throw DamagedStore(database.refusal("lacks tables; it is damaged, restore it from a backup"));
  }
}

/// Skips the stations' chains, whose content the collected study's chain repeats.
EventVisitor skipping_station_chains(const EventVisitor& visit) {
  return [&visit](const Event& event) {
    if (event.session >= 0) visit(event);
  };
}

}  // namespace

struct StudyStore::Impl {
  explicit Impl(Database opened) : study(std::move(opened)) {}

  /// Does what Database::run does.
  template <typename Work>
  decltype(auto) run(Work&& work) const {
    return database().run(std::forward<Work>(work));
  }

  /// Does what Database::change does, and updates head files.
  template <typename Work>
  void change(Work&& work) {
    study.change(std::forward<Work>(work));
    study.update_heads({});
  }

  [[nodiscard]] const Database& database() const { return study.database(); }

  StoredStudy study;
};

StudyStore::StudyStore(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
StudyStore::~StudyStore() = default;
StudyStore::StudyStore(StudyStore&&) noexcept = default;
StudyStore& StudyStore::operator=(StudyStore&&) noexcept = default;

StudyStore StudyStore::create(const std::filesystem::path& path, const StudyCommitment& commitment,
                              std::chrono::nanoseconds at, const Signer& signer) {
  refuse_link(path);
  if (path_exists(path)) refuse_existing_database(path);
  // The file gets its name when it is complete, so that a killed program leaves no part of it.
  const Draft draft(path, Draft::Kind::folder);
  const std::filesystem::path new_file = draft.path() / path.filename();
  fill(new_file, commitment, at, signer);
  if (!move_to_free_name(new_file, path)) refuse_existing_database(path);
  StudyStore store = open(path, Access::read_write);
  store.sign_with(signer);
  return store;
}

void StudyStore::fill(const std::filesystem::path& draft, const StudyCommitment& commitment,
                      std::chrono::nanoseconds at, const Signer& signer) {
  Impl impl(Database::create(draft));
  make_tables(impl.database());
  impl.change([&] {
    impl.study.append(
        signed_event(next_on_file(nullptr, EventKind::study_committed, at, to_json(commitment)),
                     signer),
        std::nullopt);
  });
  // A new file is complete without its log.
  impl.run([&] { return impl.database().checkpoint(); });
}

StudyStore StudyStore::open(const std::filesystem::path& path, Access access) {
  auto impl = std::make_unique<Impl>(Database::open(
      path, access == Access::read_write ? Database::Mode::read_write : Database::Mode::read_only));
  impl->run([&] {
    check_tables(impl->database());
    if (access == Access::read_only) return;
    // A foreign trigger could suppress new events.
    if (const auto fault = schema_fault(impl->database())) {
      impl->study.refuse(
          fault->what + "; it cannot be used for recording" +
          (fault->remedy.empty() ? ", run `touchtrial verify`" : "; remove it: " + fault->remedy));
    }
  });
  return StudyStore(std::move(impl));
}

const StudyCommitment& StudyStore::commitment() const {
  return impl_->run([&]() -> const StudyCommitment& { return impl_->study.commitment(); });
}

void StudyStore::sign_with(const Signer& signer) {
  impl_->run([&] { impl_->study.sign_with(signer); });
}

void StudyStore::set_head_writer(HeadWriter writer) {
  HeadRecord record = record_of(*this);
  impl_->study.set_head_writer(std::move(writer), std::move(record));
  impl_->study.update_heads({});
}

void StudyStore::record_heads(const std::string& also, std::chrono::nanoseconds at) {
  impl_->change([&] {
    impl_->study.append_to_file(EventKind::heads_kept, at, to_json(HeadsBody{.also = also}));
  });
}

std::optional<std::string> StudyStore::heads_on_record() const {
  constexpr EventKind kKind = EventKind::heads_kept;
  return impl_->run([&] {
    std::optional<std::string> also;
    for_each_event(impl_->database(), {.session = 0, .kinds = std::span(&kKind, 1)},
                   [&](const Event& event) { also = body_of<HeadsBody>(event).also; });
    return also;
  });
}

StudyState StudyStore::state() const {
  return impl_->run([&] { return impl_->study.state(); });
}

ChainHead StudyStore::file_head() const {
  return impl_->run([&] { return impl_->study.head(0); });
}

std::optional<SessionRow> StudyStore::session_of(const std::string& participant) const {
  return impl_->run([&] { return impl_->study.session_of(participant); });
}

std::vector<SessionRow> StudyStore::sessions_of(const std::string& participant) const {
  std::vector<SessionRow> rows = sessions();
  std::erase_if(rows, [&](const SessionRow& row) { return row.participant != participant; });
  return rows;
}

std::optional<Event> StudyStore::last_event(int session) const {
  return impl_->run([&] { return impl_->study.last_event(session); });
}

std::optional<Event> StudyStore::event_at(int session, std::int64_t sequence) const {
  return impl_->run([&] { return read_event(impl_->database(), session, sequence); });
}

std::int64_t StudyStore::answers() const {
  return impl_->run([&] {
    Query query = impl_->database().query("SELECT count(*) FROM events WHERE kind = ?");
    query.bind(name_of(EventKind::answered));
    return query.step() ? query.integer(0) : 0;
  });
}

std::vector<SessionRow> StudyStore::sessions() const {
  return impl_->run([&] {
    std::vector<SessionRow> rows;
    for (const auto& [session, row] : impl_->study.sessions()) rows.push_back(row);
    return rows;
  });
}

std::vector<TrialRow> StudyStore::trials() const {
  return impl_->run([&] { return impl_->study.trials(); });
}

std::vector<Event> StudyStore::events(int session) const {
  return impl_->run([&] {
    std::vector<Event> events;
    for_each_event(impl_->database(), session,
                   [&](const Event& event) { events.push_back(event); });
    return events;
  });
}

void StudyStore::for_each(EventKind kind, const std::function<void(const Event&)>& visit) const {
  impl_->run([&] {
    for_each_event(impl_->database(), {.kinds = std::span(&kind, 1)},
                   skipping_station_chains(visit));
  });
}

void StudyStore::for_each_of(std::span<const EventKind> kinds,
                             const std::function<void(const Event&)>& visit) const {
  if (kinds.empty()) return;
  impl_->run(
      [&] { for_each_event(impl_->database(), {.kinds = kinds}, skipping_station_chains(visit)); });
}

int StudyStore::next_session() const {
  return impl_->run([&] { return impl_->study.next_session(); });
}

int StudyStore::next_enrolment() const {
  return impl_->run([&] { return impl_->study.next_enrolment(); });
}

int StudyStore::enrolment_for(const std::string& participant) const {
  return impl_->run([&] { return impl_->study.enrolment_for(participant); });
}

WrappedKeys StudyStore::wrapped_keys(int session) const {
  return impl_->run([&] { return read_keys(impl_->database(), session); });
}

std::optional<Bytes> StudyStore::wrapped_key(int session) const {
  return wrapped_keys(session).participant;
}

std::optional<Bytes> StudyStore::kept_key(int session) const {
  return impl_->run([&]() -> std::optional<Bytes> {
    Query query = impl_->database().query("SELECT kept FROM station_keys WHERE session = ?");
    query.bind(session);
    if (!query.step()) return std::nullopt;
    return query.blob(0);
  });
}

std::optional<SealedTrace> StudyStore::sealed_trace(int session, int trial) const {
  return impl_->run([&]() -> std::optional<SealedTrace> {
    Query query = impl_->database().query("SELECT box FROM traces WHERE session = ? AND trial = ?");
    query.bind(session).bind(trial);
    if (!query.step()) return std::nullopt;
    return SealedTrace{
        .session = impl_->study.session(session).own_session, .trial = trial, .box = query.blob(0)};
  });
}

int StudyStore::stations() const {
  return impl_->run([&] { return impl_->study.stations(); });
}

std::vector<Event> StudyStore::station_chain(int station) const {
  std::vector<Event> chain = events(-station);
  for (Event& event : chain) {
    event.session = 0;
    event.renumbered_from.reset();
  }
  return chain;
}

void StudyStore::add_session(const BufferedEvents& session, const NewKeys& keys,
                             std::chrono::nanoseconds at) {
  impl_->run([&] { impl_->study.check_complete(session); });
  impl_->change([&] { impl_->study.store_complete(session, keys, at); });
}

std::unique_ptr<EventSink> StudyStore::begin_session(int session, const NewKeys& keys, UtcClock utc,
                                                     const Bytes& kept_key) {
  return std::make_unique<StoredSession>(impl_->study, session, SessionKeys{keys, kept_key},
                                         std::move(utc));
}

std::unique_ptr<EventSink> StudyStore::continue_session(int session, UtcClock utc) {
  return impl_->run([&] {
    return std::make_unique<StoredSession>(impl_->study, impl_->study.last_event_of_open(session),
                                           std::move(utc));
  });
}

void StudyStore::close_study(std::chrono::nanoseconds at) {
  impl_->change([&] {
    if (impl_->study.state().closed) impl_->study.refuse("the study is already closed");
    impl_->study.append_to_file(EventKind::study_closed, at, "{}");
  });
}

void StudyStore::unblind(std::chrono::nanoseconds at, const std::string& reason, bool interim) {
  impl_->change([&] {
    impl_->study.require_reason(reason, "unblinding");
    const bool closed = impl_->study.state().closed;
    if (!closed && !interim) {
      impl_->study.refuse("the study is still open; close it first, or look with --interim");
    }
    if (closed && interim) {
      impl_->study.refuse(
          "the study is closed, so this is not an interim look; unblind it without --interim");
    }
    impl_->study.append_to_file(EventKind::study_unblinded, at,
                                to_json(UnblindingBody{.reason = reason, .interim = interim}));
  });
}

void StudyStore::look_at_question(std::chrono::nanoseconds at, const std::string& reason) {
  impl_->change([&] {
    impl_->study.require_reason(reason, "unblinding");
    if (impl_->study.state().closed) {
      impl_->study.refuse(
          "the study is closed, so this is not an interim look; unblind it without --interim");
    }
    impl_->study.append_to_file(
        EventKind::study_unblinded, at,
        to_json(UnblindingBody{.reason = reason, .interim = true, .question_alone = true}));
  });
}

void StudyStore::look_at(const std::string& participant, std::chrono::nanoseconds at,
                         const std::string& reason) {
  impl_->change([&] {
    const std::vector<SessionRow> rows = sessions_of(participant);
    const std::string name = "participant " + participant;
    impl_->study.require_reason(reason, "a look at outcomes");
    if (rows.empty()) impl_->study.refuse(name + " has no session; check the participant id");
    if (std::ranges::all_of(rows, &SessionRow::erased)) {
      impl_->study.refuse(name +
                          " has withdrawn, and the data are erased; there is nothing to see");
    }
    for (const SessionRow& row : rows) {
      if (!row.can_resume()) continue;
      impl_->study.refuse("session " + std::to_string(row.session) + " (" + name +
                          ") may still continue; look at it when it has ended");
    }
    const bool interim = !impl_->study.state().closed;
    impl_->study.append_to_file(
        EventKind::study_unblinded, at,
        to_json(UnblindingBody{.reason = reason, .interim = interim, .participant = participant}));
  });
}

void StudyStore::exclude(int session, std::chrono::nanoseconds at, const std::string& reason) {
  impl_->change([&] {
    impl_->study.require_reason(reason, "an exclusion");
    if (impl_->study.session(session).excluded) {
      impl_->study.refuse("session " + std::to_string(session) + " is already excluded");
    }
    const bool was_seen = impl_->study.state().shows(session);
    impl_->study.append_about(
        session, EventKind::participant_excluded, at,
        to_json(ParticipantBody{.session = session, .reason = reason, .after_outcomes = was_seen}));
  });
}

void StudyStore::withdraw(int session, std::chrono::nanoseconds at, const std::string& reason,
                          Retention kept, const std::string& not_erased) {
  withdraw(std::span(&session, 1), at, reason, kept, not_erased);
}

void StudyStore::withdraw(std::span<const int> sessions, std::chrono::nanoseconds at,
                          const std::string& reason, Retention kept,
                          const std::string& not_erased) {
  impl_->change([&] {
    for (const int session : sessions) {
      impl_->study.withdraw(
          {.session = session, .kept = kept, .reason = reason, .not_erased = not_erased}, at);
    }
  });
  if (kept == Retention::data) return impl_->run([&] { impl_->study.empty_log(); });
  // The log still contains pages with the keys.
  if (!clear_log()) {
    impl_->study.refuse(
        "the withdrawal is recorded, but another program keeps the key in the file's -wal; close "
        "that program, then open and close the database once for writing");
  }
}

void StudyStore::replace(int session, const std::string& by, std::chrono::nanoseconds at,
                         const std::string& reason) {
  impl_->change([&] {
    impl_->study.require_reason(reason, "a replacement");
    impl_->study.replace({.session = session, .by = by, .reason = reason}, at);
  });
}

void StudyStore::note(int session, std::chrono::nanoseconds at, const std::string& code,
                      const std::string& text) {
  impl_->change([&] {
    static_cast<void>(impl_->study.session(session));
    if (code.empty() && text.empty()) impl_->study.refuse("the note is empty; give it a text");
    impl_->study.append_about(session, EventKind::participant_noted, at,
                              to_json(NoteBody{.session = session, .code = code, .text = text}));
  });
}

void StudyStore::accept_loss(const LossBody& loss, const std::map<int, std::string>& sessions,
                             std::chrono::nanoseconds at) {
  impl_->change([&] {
    impl_->study.require_reason(loss.reason, "accepting a loss");
    impl_->study.append_to_file(EventKind::loss_accepted, at, to_json(loss));
    for (const auto& [session, what] : sessions) {
      static_cast<void>(impl_->study.session(session));
      impl_->study.append_about(
          session, EventKind::participant_noted, at,
          to_json(NoteBody{.session = session, .code = "answers-lost", .text = what}));
    }
  });
}

std::optional<ChainFault> StudyStore::first_fault(TraceCheck traces,
                                                  const SessionReader& reader) const {
  return impl_->run([&] {
    // One transaction, for a consistent snapshot while others write.
    SQLite::Transaction snapshot(impl_->database().connection());
    return find_first_fault(impl_->database(), traces, reader);
  });
}

namespace {

void copy(const Database& database, const std::filesystem::path& to) {
  const Draft draft(to, Draft::Kind::folder);
  const std::filesystem::path new_file = draft.path() / to.filename();
  database.run([&] { database.copy_to(new_file); });
  move_to_output(new_file, to);
}

}  // namespace

bool StudyStore::clear_log() const {
  return impl_->run([&] { return impl_->database().checkpoint(); });
}

void StudyStore::copy_to(const std::filesystem::path& path) const {
  copy(impl_->database(), path);
}

void copy_database(const std::filesystem::path& from, const std::filesystem::path& to) {
  copy(Database::open(from, Database::Mode::read_only), to);
}

}  // namespace touchtrial::record
