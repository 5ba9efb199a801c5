#include "protocols/procedures/tracks.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace touchtrial::procedures {
namespace {

/// An order of tracks in rounds. Each round has every track with remaining turns once, in random
/// order.
/// \param turns  of each track
std::vector<std::size_t> in_rounds(std::span<const int> turns, RandomStream& random) {
  std::vector<std::size_t> order;
  for (int done = 0;; ++done) {
    std::vector<std::size_t> round;
    for (std::size_t track = 0; track < turns.size(); ++track) {
      if (turns[track] > done) round.push_back(track);
    }
    if (round.empty()) return order;
    shuffle(std::span(round), random);
    order.insert(order.end(), round.begin(), round.end());
  }
}

std::vector<std::size_t> order_of_tracks(const std::vector<TrackSettings>& tracks,
                                         RandomStream& random) {
  std::vector<int> turns;
  for (const TrackSettings& track : tracks) turns.push_back(track.trials);
  return in_rounds(turns, random);
}

/// Inserts catch trials before trials of tracks.
std::vector<Presentation> with_catch_trials(const std::vector<std::size_t>& order, int catch_trials,
                                            std::size_t tracks, RandomStream& random) {
  const auto wanted = static_cast<std::size_t>(catch_trials);
  if (catch_trials < 0 || 2 * wanted > order.size()) {
    throw std::invalid_argument("catch_trials must be from 0 to half of the tracks' trials");
  }
  std::vector<bool> before(order.size(), false);
  for (std::size_t i = 0; i < wanted; ++i) {
    const std::size_t begin = std::max<std::size_t>(1, i * order.size() / wanted);
    const std::size_t end = (i + 1) * order.size() / wanted;
    before[begin + static_cast<std::size_t>(random.below(end - begin))] = true;
  }
  // More rounds than needed; the last ones are not used.
  const std::vector<std::size_t> whose = in_rounds(std::vector<int>(tracks, catch_trials), random);
  std::vector<Presentation> all;
  std::size_t caught = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (before[i]) all.push_back({.track = whose[caught++], .is_catch = true});
    all.push_back({.track = order[i]});
  }
  return all;
}

}  // namespace

Block::Block(BlockSettings settings, const Digest& secret) : settings_(std::move(settings)) {
  if (settings_.tracks.empty() || settings_.tracks.size() > kMaxTracks) {
    throw std::invalid_argument("a block must have 1 to 8 tracks");
  }
  for (const TrackSettings& track : settings_.tracks) {
    RandomStream own(secret, "procedures/track", tracks_.size());
    tracks_.push_back({make_procedure(track, own), {}});
  }
  RandomStream orders(secret, "procedures/order");
  RandomStream catches(secret, "procedures/catch");
  order_ = with_catch_trials(order_of_tracks(settings_.tracks, orders), settings_.catch_trials,
                             tracks_.size(), catches);
}

std::optional<Presentation> Block::next() const {
  if (done_ == order_.size()) return std::nullopt;
  Presentation next = order_[done_];
  next.level = next.is_catch ? settings_.tracks[next.track].levels.size() - 1
                             : tracks_[next.track].procedure->next();
  return next;
}

void Block::answer(bool correct) {
  const std::optional<Presentation> now = next();
  if (!now) return;
  ++done_;
  if (now->is_catch) return;
  Track& track = tracks_[now->track];
  track.trials.push_back({now->level, correct});
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

std::optional<std::size_t> first_not_chosen(const BlockSettings& settings, const Digest& secret,
                                            std::span<const RecordedTrial> record) {
  Block block(settings, secret);
  for (std::size_t i = 0; i < record.size(); ++i) {
    const std::optional<Presentation> now = block.next();
    if (now != record[i].presentation) return i;
    block.answer(record[i].correct);
  }
  return std::nullopt;
}

std::vector<LevelCounts> counts_of(std::span<const double> levels,
                                   std::span<const TrackTrial> trials) {
  std::vector<LevelCounts> all(levels.size());
  for (std::size_t i = 0; i < levels.size(); ++i) all[i].level = levels[i];
  for (const TrackTrial& trial : trials) {
    ++all[trial.level].n;
    if (trial.correct) ++all[trial.level].correct;
  }
  std::erase_if(all, [](const LevelCounts& at) { return at.n == 0; });
  return all;
}

}  // namespace touchtrial::procedures
