/// \file A collected study while it is being made: the stations' chains as they are, the chain that
/// they come to, and their sessions, each checked as it comes in. Source: docs/data-dictionary.md,
/// "Collected studies".
#pragma once

#include "core/bytes.hpp"
#include "record/collected_chain.hpp"
#include "record/event.hpp"
#include "record/sealing.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace touchtrial::record {

/// Not to be shared between threads. A draft that is not finished leaves nothing behind.
class CollectedDraft {
 public:
  /// A file beside `target`, which gets that name when it is finished.
  /// \throws StoreError if the target exists or nothing can be made there
  [[nodiscard]] static CollectedDraft in_file(const std::filesystem::path& target);

  ~CollectedDraft();
  CollectedDraft(CollectedDraft&&) noexcept;
  CollectedDraft& operator=(CollectedDraft&&) = delete;

  /// Must be called first.
  /// \param stations  in the order of comes_before, each checked (checked_file_chain)
  /// \throws what collected_chain throws; StoreError if it cannot be written
  const CollectedChain& begin(std::span<const StationChain> stations);

  /// Must be called for each session, in the order of their numbers.
  /// \param session  from 1
  /// \param events  as the station has them: own numbers, not renumbered
  /// \throws EventFault, with the session's own number, if anything does not hold
  /// \throws StoreError if the session is seen on a screen and others are felt, or the other way
  ///   round, or it cannot be written
  void add_session(int session, std::span<const Event> events, const WrappedKeys& keys);
  /// A trace of the session that was added last; traces may come in any order.
  /// \throws the same
  void add_trace(int trial, const Bytes& box);
  /// After a session's traces: checks that none is missing.
  /// \throws the same
  void end_traces() const;

  /// After all sessions: gives the file its name.
  /// \throws StoreError if it cannot be written, or another file has taken the name meanwhile
  void finish() &&;

 private:
  struct Impl;
  explicit CollectedDraft(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace touchtrial::record
