/// \file Interleaved tracks with catch trials: the presentations of one block, as a function of
/// settings, a secret and the answers. Catch trials have the highest level of a track, near its
/// asymptote, where only lapses cause wrong answers. Source: docs/thresholds.md, "Tracks".
#pragma once

#include "core/hash.hpp"
#include "protocols/procedures/procedure.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace touchtrial::procedures {

constexpr std::size_t kMaxTracks = 8;

struct BlockSettings {
  std::vector<TrackSettings> tracks;  ///< 1 to 8
  int catch_trials = 0;               ///< of all tracks together, 0 to half of their trials
};

/// One trial of a track: its level, and whether the answer was right.
struct TrackTrial {
  std::size_t level = 0;  ///< index
  bool correct = false;
};

/// A trial of a track. The answers to catch trials are not passed to the procedure, but enter the
/// track's estimate.
struct Presentation {
  std::size_t track = 0;  ///< index
  std::size_t level = 0;  ///< index into the track's levels
  bool is_catch = false;

  friend bool operator==(const Presentation&, const Presentation&) = default;
};

/// A block of interleaved tracks. The order of tracks is drawn before the first trial, so that it
/// reveals nothing about answers: in each round every track with remaining trials occurs once, in
/// random order. The trials are divided into equal stretches, each with one catch trial at a random
/// place, but never as the first trial of the block. Catch trials are assigned to tracks in rounds,
/// too, so that their numbers differ by at most one.
/// Not thread-safe.
class Block {
 public:
  /// \param secret  determines the orders; each track has its own random stream
  /// \throws std::invalid_argument if a setting is out of range
  Block(BlockSettings settings, const Digest& secret);

  /// The next trial; nothing when all are answered.
  [[nodiscard]] std::optional<Presentation> next() const;

  /// Records the answer to the trial at next(); has no effect if there is none.
  void answer(bool correct);

  /// The trials of a track so far, without catch trials.
  /// \param track  index
  /// \throws std::out_of_range if there is no such track
  [[nodiscard]] std::span<const TrackTrial> trials(std::size_t track) const;
  [[nodiscard]] const BlockSettings& settings() const noexcept { return settings_; }

 private:
  struct Track {
    std::unique_ptr<Procedure> procedure;
    std::vector<TrackTrial> trials;
  };

  BlockSettings settings_;
  std::vector<Track> tracks_;
  std::vector<Presentation> order_;  ///< without levels
  std::size_t answer_count_ = 0;
};

/// Recreates the state of a block after these answers, to resume a session or verify its record.
/// \throws std::invalid_argument as Block, or if there are more answers than trials
[[nodiscard]] Block replay(const BlockSettings& settings, const Digest& secret,
                           const std::vector<bool>& answers);

/// A recorded presentation, and whether its answer was right.
struct RecordedTrial {
  Presentation presentation;
  bool correct = false;
};

/// Verifies a record.
/// \return index of the first trial that the block would not have presented after the previous
///   answers, or that follows the block's end; empty if there is none
/// \throws std::invalid_argument as Block
[[nodiscard]] std::optional<std::size_t> first_mismatch(const BlockSettings& settings,
                                                        const Digest& secret,
                                                        std::span<const RecordedTrial> record);

/// Counts of answers at each level of a track, ascending; levels without trials are omitted.
/// \pre the trials are of this track
[[nodiscard]] std::vector<LevelCounts> counts_of(std::span<const double> levels,
                                                 std::span<const TrackTrial> trials);

}  // namespace touchtrial::procedures
