/// \file How sessions get into a database: event by event, or whole.
/// Private to protocols/store.
#pragma once

#include "protocols/store/chain_link.hpp"
#include "protocols/store/stored_study.hpp"

namespace touchtrial::store {

/// The durable sink: every event is one transaction.
class StoredSession final : public EventSink {
 public:
  /// \param study  must outlive this
  StoredSession(StoredStudy& study, int session, Bytes wrapped_key, UtcClock utc);
  /// Goes on with a session that is stored and open. \param last  its last event
  StoredSession(StoredStudy& study, const Event& last, UtcClock utc);

  void accept(const Event& event, const std::optional<SealedTrace>& trace) override;
  void accept_together(std::span<const RecordedEvent> events) override;

 private:
  StoredSession(StoredStudy& study, ChainLink chain, Bytes wrapped_key, UtcClock utc);
  void refuse_if_others_wrote(int session) const;
  void store(const Event& event, const std::optional<SealedTrace>& trace, bool first);

  StoredStudy& study_;
  ChainLink chain_;
  Bytes wrapped_key_;
  UtcClock utc_;
};

/// Holds the events of a finished session against each other. \throws StoreError, EventFault
void check_whole_session(const StoredStudy& study, const BufferedEvents& session);
/// Stores it. \pre inside a write transaction, and check_whole_session found no fault
void store_whole_session(StoredStudy& study, const BufferedEvents& session,
                         const Bytes& wrapped_key, std::chrono::nanoseconds at);

}  // namespace touchtrial::store
