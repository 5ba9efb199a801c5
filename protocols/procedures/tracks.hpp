/// \file Interleaved tracks with catch trials: what comes next in one block of trials, as a function
/// of settings, a secret and the answers. Catch trials are at the highest level of a track, near
/// its asymptote, where only lapses make answers wrong. Source: docs/thresholds.md, "Tracks".
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
  int catch_trials = 0;               ///< of all tracks, >= 0, at most one for each two trials
};

/// One trial of a track: its level and what was answered.
struct TrackTrial {
  std::size_t level = 0;  ///< index
  bool correct = false;
};

/// A trial of a track. The procedure does not hear of a catch trial; the track's estimate does.
struct Presentation {
  std::size_t track = 0;  ///< index
  std::size_t level = 0;  ///< index into the track's levels
  bool is_catch = false;

  friend bool operator==(const Presentation&, const Presentation&) = default;
};

/// The order of tracks is dealt before the first trial, so it tells nothing of answers: in each
/// round every track that still has trials comes once, in random order. The trials are cut into as
/// many equal stretches as there are catch trials; each has one at a random place, never the first
/// of all. Catch trials are dealt to tracks in rounds too, so that tracks differ by one at most.
/// Not thread-safe.
class Block {
 public:
  /// \param secret  decides orders; each track has a stream of its own
  /// \throws std::invalid_argument if a setting is outside its range
  Block(BlockSettings settings, const Digest& secret);

  /// \return nothing when all trials are answered
  [[nodiscard]] std::optional<Presentation> next() const;

  /// The answer to the trial at next(); without effect when there is none.
  void answer(bool correct);

  /// The trials of a track so far that its procedure chose.
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
  std::size_t done_ = 0;
};

/// The block after these answers: how a session is resumed, and how its record is verified.
/// \throws what Block throws; std::invalid_argument if there are more answers than trials
[[nodiscard]] Block replay(const BlockSettings& settings, const Digest& secret,
                           const std::vector<bool>& answers);

/// A presentation of a record, and what was answered.
struct RecordedTrial {
  Presentation presentation;
  bool correct = false;
};

/// The check of a record.
/// \return index of the first trial whose presentation the block would not have chosen after the
///   answers before it, or that comes after its end; nothing if there is none
/// \throws what Block throws
[[nodiscard]] std::optional<std::size_t> first_not_chosen(const BlockSettings& settings,
                                                          const Digest& secret,
                                                          std::span<const RecordedTrial> record);

/// Answers at each level of a track, ascending; levels without trials are left out.
/// \pre the trials are of this track
[[nodiscard]] std::vector<LevelCounts> counts_of(std::span<const double> levels,
                                                 std::span<const TrackTrial> trials);

}  // namespace touchtrial::procedures
