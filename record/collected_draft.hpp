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

/// Not thread-safe. An unfinished draft leaves no file behind.
class CollectedDraft {
 public:
  /// Creates a file beside `target`, which `finish` renames to it.
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
  /// \param events  with the station's session number, not renumbered
  /// \throws EventFault, with the station's session number, at any fault
  /// \throws StoreError if it cannot be written, or it mixes sessions on a screen with sessions
  ///   with a haptic device
  void add_session(int session, std::span<const Event> events, const WrappedKeys& keys);
  /// Adds a trace of the last added session, in any order.
  /// \throws as add_session
  void add_trace(int trial, const Bytes& box);
  /// Checks, after a session's traces, that none is missing.
  /// \throws as add_session
  void end_traces() const;

  /// Renames the file to its target. Must be called after all sessions.
  /// \throws StoreError if it cannot be written, or another file has taken its name
  void finish() &&;

 private:
  struct Impl;
  explicit CollectedDraft(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace touchtrial::record
