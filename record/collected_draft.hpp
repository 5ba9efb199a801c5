/// \file A collected study under construction: the stations' chains, the chain collected from them,
/// and their sessions, each checked when it is added. Source: docs/data-dictionary.md, "Collected
/// studies".
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

/// Not to be shared between threads. An unfinished draft leaves no file behind.
class CollectedDraft {
 public:
  /// A file beside `target`, renamed to it when finished.
  /// \throws StoreError if the target exists or no file can be created there
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
  /// \param events  as the station has them: with own numbers, not renumbered
  /// \throws EventFault, with the session's own number, at any fault
  /// \throws StoreError if it cannot be written, or some sessions are on a screen and others with a
  ///   haptic device
  void add_session(int session, std::span<const Event> events, const WrappedKeys& keys);
  /// Adds a trace of the last added session, in any order.
  /// \throws the same
  void add_trace(int trial, const Bytes& box);
  /// After a session's traces: checks that none is missing.
  /// \throws the same
  void end_traces() const;

  /// After all sessions: renames the file to its target.
  /// \throws StoreError if it cannot be written, or another file has that name by now
  void finish() &&;

 private:
  struct Impl;
  explicit CollectedDraft(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace touchtrial::record
