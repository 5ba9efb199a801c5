#include "protocols/collect/arrival_check.hpp"

#include "protocols/collect/server_rows.hpp"
#include "protocols/collect/server_study.hpp"
#include "protocols/store/chain_link.hpp"
#include "protocols/store/event_fault.hpp"

#include <algorithm>
#include <string>

namespace touchtrial::collect {
namespace {

/// One session on its arrival.
class ArrivedSession {
 public:
  ArrivedSession(const ServerConnection& server, int own_session)
      : server_(server), own_session_(own_session) {}

  [[noreturn]] void refuse(const std::string& why) const {
    server_.refuse("session " + std::to_string(own_session_) + " did not arrive whole: " + why +
                   "; nothing of it was kept, run `touchtrial verify` on the station's file");
  }
  void require(bool holds, const std::string& otherwise) const {
    if (!holds) refuse(otherwise);
  }

  void check_chain(std::span<const store::Event> events, const SessionCourse& course) const {
    store::ChainLink chain(own_session_);
    for (const store::Event& event : events) {
      if (const auto broken = chain.broken_by(event)) {
        refuse("event " + std::to_string(event.sequence) + ": " + *broken);
      }
      chain.extend(event);
    }
    require(!events.empty() && events.front().hash == course.opened.first,
            "it begins with another event than the file's chain says");
    require(chain.length() == course.end.length && chain.head() == course.end.head,
            "it ends with another event than the file's chain says");
  }

  void check_opening(const store::Event& event, const SessionCourse& course,
                     const store::StudyCommitment& commitment) const {
    const store::SessionOpening opening = store::body_of(event, store::opening_from_json);
    require(opening.study_id == commitment.study_id && opening.seal == commitment.seal,
            "it was recorded under another seal");
    require(opening.participant == course.opened.participant &&
                opening.enrolment == course.opened.enrolment,
            "it is another participant's than the file's chain says");
  }

  void check_traces(std::span<const store::Event> events,
                    std::map<std::int64_t, Bytes> digests) const {
    for (const store::Event& event : events) {
      if (event.kind != store::EventKind::trace_stored) continue;
      const store::TraceBody body = store::body_of(event, store::trace_body_from_json);
      const auto found = digests.extract(body.trial);
      require(!found.empty() && std::equal(body.trace.begin(), body.trace.end(),
                                           found.mapped().begin(), found.mapped().end()),
              "the trace of trial " + std::to_string(body.trial) + " is not the one recorded");
    }
    require(digests.empty(), "there is a trace without an event");
  }

  void check_key(const std::optional<Bytes>& wrapped, const SessionCourse& course,
                 bool has_key) const {
    require(wrapped.has_value() == has_key, "the participant's key is missing or too many");
    require(!wrapped || sha256(*wrapped) == course.opened.key, "the participant's key is another");
  }

  void check_sealed_end(const Bytes& wrapped, const SecretKey& master,
                        std::span<const store::Event> events) const {
    const auto key = store::unwrap_participant_key(master, own_session_, wrapped);
    require(key.has_value(), "its key does not open with the study's key");
    const auto secret = store::unsealed(events.back(), *key);
    require(secret.has_value(), "its sealed end does not open");
    const store::ChainEnd end = store::chain_end_from_json(*secret);
    require(end.length == static_cast<std::int64_t>(events.size()) - 1 &&
                end.head == events.back().previous,
            "its sealed end is that of another chain");
  }

 private:
  const ServerConnection& server_;
  int own_session_;
};

}  // namespace

void check_session_arrival(pqxx::work& work, const ServerConnection& server, int session,
                           int own_session, const SessionCourse& course,
                           const store::StudyCommitment& commitment,
                           const std::optional<SecretKey>& master, bool has_key) {
  const ArrivedSession arrived(server, own_session);
  const std::vector<store::Event> events = read_events(work, session);
  arrived.check_chain(events, course);
  arrived.check_opening(events.front(), course, commitment);
  arrived.check_traces(events, trace_digests(work, session));
  const std::optional<Bytes> wrapped = read_key(work, session);
  arrived.check_key(wrapped, course, has_key);
  if (master && wrapped) arrived.check_sealed_end(*wrapped, *master, events);
}

void check_chain_arrival(pqxx::work& work, const ServerConnection& server, int station,
                         std::span<const store::Event> file_chain, std::int64_t first) {
  const std::vector<store::Event> tail = read_events(work, chain_number(station), first);
  store::ChainLink chain =
      first == 0 ? store::ChainLink(0)
                 : store::ChainLink::after(file_chain[static_cast<std::size_t>(first - 1)]);
  for (const store::Event& event : tail) {
    if (const auto broken = chain.broken_by(event)) {
      server.refuse("the file's chain did not arrive whole: event " +
                    std::to_string(event.sequence) + ": " + *broken + "; nothing of it was kept");
    }
    chain.extend(event);
  }
  if (chain.head() != file_chain.back().hash) {
    server.refuse("the file's chain did not arrive whole; nothing of it was kept");
  }
}

}  // namespace touchtrial::collect
