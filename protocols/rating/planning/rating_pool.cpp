#include "protocols/rating/planning/rating_pool.hpp"

#include "core/parallel.hpp"
#include "protocols/rating/analysis/rating_statistics.hpp"
#include "protocols/rating/study/rating.hpp"
#include "protocols/simulation/population.hpp"

#include <cstddef>
#include <memory>
#include <mutex>
#include <span>

namespace touchtrial::planning::rating {
namespace {

using analysis::rating::Item;
using analysis::rating::RatedParticipant;

/// Every class with both methods.
std::vector<Item> items_of(const study::Study& study, const MethodPair& pair) {
  std::vector<Item> items;
  for (int shown = 0; shown < static_cast<int>(study.classes.size()); ++shown) {
    items.push_back({shown, pair.first});
    items.push_back({shown, pair.second});
  }
  return items;
}

/// \return the scored ratings on each scale; empty if a session ended early
std::optional<std::vector<RatedParticipant>> ratings_of_person(const PoolSetting& setting,
                                                               int number, std::size_t scales) {
  std::vector<RatedParticipant> ratings(scales);
  const auto note = [&ratings](const study::Order&, const study::Trial& shown,
                               const Answer& answer) {
    if (shown.role != study::Role::scored) return;
    const study::StimulusIndex felt = shown.field();
    const std::vector<double> values = ratings_of(answer);
    for (std::size_t scale = 0; scale < ratings.size(); ++scale) {
      ratings[scale].scored.push_back({{felt.class_index, felt.method}, values.at(scale)});
    }
  };
  if (!run_pool_sessions(setting, number, note)) return std::nullopt;
  return ratings;
}

/// Computes the statistics of the report for a single participant.
PooledRating pooled(const RatedParticipant& person, std::span<const Item> items,
                    const MethodPair& pair, const analysis::Interval& ends) {
  const std::span<const RatedParticipant> alone(&person, 1);
  PooledRating own;
  for (const auto& method : analysis::rating::rating_means(alone, items, ends).methods) {
    (method.group == pair.first ? own.first : own.second) = method.mean.mean;
  }
  const auto differences = analysis::rating::method_differences(alone, items, ends);
  own.difference = differences.at(0).difference.mean;
  if (own.difference && differences[0].first == pair.second) own.difference = -*own.difference;
  return own;
}

RatingPool empty_pool(const study::Study& study) {
  RatingPool pool;
  for (const study::Scale& scale : study::rating::scales_of(study)) {
    pool.scales.push_back({scale.id, {scale.min(), scale.max()}, {}});
  }
  return pool;
}

}  // namespace

RatingPool simulated_ratings(const study::StudyKey& key, const session::StimulusSource& source,
                             const simulation::SubjectModel& subject, const MethodPair& pair,
                             const RatingPoolOptions& options, const study::Progress& progress) {
  const std::unique_ptr<const simulation::Population> population =
      simulation::population_of({key, source, subject, options.seed, options.jobs});
  const PoolSetting setting{key, source, subject, *population};
  RatingPool pool = empty_pool(key.study);
  std::vector<std::optional<std::vector<RatedParticipant>>> found(
      static_cast<std::size_t>(options.people));
  std::mutex counting;
  int done = 0;
  in_parallel(options.jobs, found.size(), [&](std::size_t i) {
    found[i] = ratings_of_person(setting, static_cast<int>(i) + 1, pool.scales.size());
    const std::lock_guard lock(counting);
    if (progress) progress(++done, options.people);
  });
  const std::vector<Item> items = items_of(key.study, pair);
  for (const auto& ratings : found) {
    ++(ratings ? pool.people : pool.unfinished);
    if (!ratings) continue;
    for (std::size_t i = 0; i < pool.scales.size(); ++i) {
      PooledScale& scale = pool.scales[i];
      scale.people.push_back(pooled((*ratings)[i], items, pair, scale.ends));
    }
  }
  return pool;
}

}  // namespace touchtrial::planning::rating
