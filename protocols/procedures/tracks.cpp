#include "protocols/procedures/tracks.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace touchtrial::procedures {
namespace {

/// Orders tracks in rounds. Each round has every track with remaining trials once, in random order.
/// \param trial_counts  by track
std::vector<std::size_t> rounds_of_tracks(std::span<const int> trial_counts, RandomStream& random) {
  std::vector<std::size_t> order;
  for (int round_number = 0;; ++round_number) {
    std::vector<std::size_t> round;
    for (std::size_t track = 0; track < trial_counts.size(); ++track) {
      if (trial_counts[track] > round_number) round.push_back(track);
    }
    if (round.empty()) return order;
    shuffle(std::span(round), random);
    order.insert(order.end(), round.begin(), round.end());
  }
}

std::vector<std::size_t> order_of_tracks(const std::vector<TrackSettings>& tracks,
                                         RandomStream& random) {
  std::vector<int> trial_counts;
  for (const TrackSettings& track : tracks) trial_counts.push_back(track.trials);
  return rounds_of_tracks(trial_counts, random);
}

/// Inserts catch trials at random places between the trials of the tracks.
std::vector<Presentation> insert_catch_trials(const std::vector<std::size_t>& order,
                                              int catch_trials, std::size_t tracks,
                                              RandomStream& random) {
  const auto count = static_cast<std::size_t>(catch_trials);
  if (catch_trials < 0 || 2 * count > order.size()) {
    throw std::invalid_argument("catch_trials must be from 0 to half of the tracks' trials");
  }
  std::vector<bool> has_catch(order.size(), false);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t begin = std::max<std::size_t>(1, i * order.size() / count);
    const std::size_t end = (i + 1) * order.size() / count;
    has_catch[begin + static_cast<std::size_t>(random.below(end - begin))] = true;
  }
  // This draws more rounds than are needed; the last ones are not used.
  const std::vector<std::size_t> catch_tracks =
      rounds_of_tracks(std::vector<int>(tracks, catch_trials), random);
  std::vector<Presentation> presentations;
  std::size_t catches = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (has_catch[i]) presentations.push_back({.track = catch_tracks[catches++], .is_catch = true});
    presentations.push_back({.track = order[i]});
  }
  return presentations;
}

}  // namespace

Block::Block(BlockSettings settings, const Digest& secret) : settings_(std::move(settings)) {
  if (settings_.tracks.empty() || settings_.tracks.size() > kMaxTracks) {
    throw std::invalid_argument("a block must have 1 to 8 tracks");
  }
  for (const TrackSettings& track : settings_.tracks) {
    RandomStream stream(secret, "procedures/track", tracks_.size());
    tracks_.push_back({make_procedure(track, stream), {}});
  }
  RandomStream orders(secret, "procedures/order");
  RandomStream catches(secret, "procedures/catch");
  order_ = insert_catch_trials(order_of_tracks(settings_.tracks, orders), settings_.catch_trials,
                               tracks_.size(), catches);
}

std::optional<Presentation> Block::next() const {
  if (answer_count_ == order_.size()) return std::nullopt;
  Presentation presentation = order_[answer_count_];
  presentation.level = presentation.is_catch
                           ? settings_.tracks[presentation.track].levels.size() - 1
                           : tracks_[presentation.track].procedure->next();
  return presentation;
}

void Block::answer(bool correct) {
  const std::optional<Presentation> presented = next();
  if (!presented) return;
  ++answer_count_;
  if (presented->is_catch) return;
  Track& track = tracks_[presented->track];
  track.trials.push_back({presented->level, correct});
  track.procedure->answer(correct);
}

std::span<const TrackTrial> Block::trials(std::size_t track) const {
  return tracks_.at(track).trials;
}

Block replay(const BlockSettings& settings, const Digest& secret,
             const std::vector<bool>& answers) {
  Block block(settings, secret);
  for (const bool correct : answers) {
    if (!block.next()) throw std::invalid_argument("there are more answers than trials");
    block.answer(correct);
  }
  return block;
}

std::optional<std::size_t> first_mismatch(const BlockSettings& settings, const Digest& secret,
                                          std::span<const RecordedTrial> record) {
  Block block(settings, secret);
  for (std::size_t i = 0; i < record.size(); ++i) {
    if (block.next() != record[i].presentation) return i;
    block.answer(record[i].correct);
  }
  return std::nullopt;
}

std::vector<LevelCounts> counts_of(std::span<const double> levels,
                                   std::span<const TrackTrial> trials) {
  std::vector<LevelCounts> counts(levels.size());
  for (std::size_t i = 0; i < levels.size(); ++i) counts[i].level = levels[i];
  for (const TrackTrial& trial : trials) {
    ++counts[trial.level].n;
    if (trial.correct) ++counts[trial.level].correct;
  }
  std::erase_if(counts, [](const LevelCounts& point) { return point.n == 0; });
  return counts;
}

}  // namespace touchtrial::procedures
