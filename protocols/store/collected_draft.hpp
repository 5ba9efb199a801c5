/// \file A collected study while it is being made: stations' chains kept as they are, the chain
/// that they come to, and their sessions, each checked as it comes in. Source:
/// docs/data-dictionary.md, "Collected studies".
#pragma once

#include "core/bytes.hpp"
#include "protocols/store/collected_chain.hpp"
#include "protocols/store/event.hpp"
#include "protocols/store/study_store.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace touchtrial::store {

class Database;

/// \throws EventFault if a station's file chain does not hold by itself: links, hashes, and what
/// the
///   events say of each other
void check_file_chain(std::span<const Event> chain);

/// Not to be shared between threads. What is not finished leaves nothing behind.
class CollectedDraft {
 public:
  /// A file beside `target`, that gets that name when it is finished.
  /// \throws StoreError if the target exists or nothing can be made there
  [[nodiscard]] static CollectedDraft in_file(const std::filesystem::path& target);
  /// A private temporary database of SQLite: no other program can open it.
  /// \param name  for messages
  [[nodiscard]] static CollectedDraft temporary(const std::string& name);

  ~CollectedDraft();
  CollectedDraft(CollectedDraft&&) noexcept;
  CollectedDraft& operator=(CollectedDraft&&) = delete;

  /// First of all. \param stations  in the order of comes_before, each checked (check_file_chain)
  /// \throws what collected_chain throws; StoreError if it cannot be written
  const CollectedChain& begin(std::span<const StationChain> stations);

  /// The sessions in the order of their numbers. \param session  from 1
  /// \param events  as the station has them: own numbers, not renumbered
  /// \throws EventFault, with the session's own number, if anything does not hold; StoreError if
  ///   this is seen on a screen and others are felt, or it cannot be written
  void add_session(int session, std::span<const Event> events, const std::optional<Bytes>& key);
  /// The traces of the session that was added last, in any order. \throws the same
  void add_trace(int trial, const Bytes& box);
  /// After its traces: that none is missing. Not called where traces are fetched. \throws the same
  void end_traces() const;

  /// After all sessions: a file gets its name.
  /// \param fetch  where traces are that were not added; empty: nowhere
  /// \throws StoreError if it cannot be written, or somebody has taken the name meanwhile
  [[nodiscard]] StudyStore finished(TraceFetch fetch = {}) &&;

 private:
  struct Impl;
  explicit CollectedDraft(std::unique_ptr<Impl> impl);
  [[nodiscard]] static StudyStore store_of(Database database, TraceFetch fetch);
  std::unique_ptr<Impl> impl_;
};

}  // namespace touchtrial::store
