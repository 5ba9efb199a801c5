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

std::vector<Item> items_of(const study::Study& study, const MethodPair& pair) {
  std::vector<Item> items;
  for (int class_index = 0; class_index < static_cast<int>(study.classes.size()); ++class_index) {
    items.push_back({class_index, pair.first});
    items.push_back({class_index, pair.second});
  }
  return items;
}

/// \return the scored ratings on each scale; empty if a session was not completed
std::optional<std::vector<RatedParticipant>> ratings_of_person(const PoolSetting& setting,
                                                               int number, std::size_t scales) {
  std::vector<RatedParticipant> ratings(scales);
  const auto add_rating = [&ratings](const study::Order&, const study::Trial& presented,
                                     const Answer& answer) {
    if (presented.role != study::Role::scored) return;
    const study::StimulusIndex stimulus = presented.field();
    const std::vector<double> values = ratings_of(answer);
    for (std::size_t scale = 0; scale < ratings.size(); ++scale) {
      ratings[scale].scored.push_back({{stimulus.class_index, stimulus.method}, values.at(scale)});
    }
  };
  if (!run_pool_sessions(setting, number, add_rating)) return std::nullopt;
  return ratings;
}

/// Computes the report's statistics for a single participant.
PooledRating pooled_rating(const RatedParticipant& person, std::span<const Item> items,
                           const MethodPair& pair, const analysis::Interval& ends) {
  const std::span<const RatedParticipant> single_person(&person, 1);
  PooledRating rating;
  for (const auto& method : analysis::rating::rating_means(single_person, items, ends).methods) {
    (method.group == pair.first ? rating.first : rating.second) = method.mean.mean;
  }
  const auto differences = analysis::rating::method_differences(single_person, items, ends);
  rating.difference = differences.at(0).difference.mean;
  if (rating.difference && differences[0].first == pair.second) {
    rating.difference = -*rating.difference;
  }
  return rating;
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
  std::vector<std::optional<std::vector<RatedParticipant>>> all_ratings(
      static_cast<std::size_t>(options.people));
  std::mutex progress_mutex;
  int finished = 0;
  in_parallel(options.jobs, all_ratings.size(), [&](std::size_t i) {
    all_ratings[i] = ratings_of_person(setting, static_cast<int>(i) + 1, pool.scales.size());
    const std::lock_guard lock(progress_mutex);
    if (progress) progress(++finished, options.people);
  });
  const std::vector<Item> items = items_of(key.study, pair);
  for (const auto& ratings : all_ratings) {
    ++(ratings ? pool.people : pool.unfinished);
    if (!ratings) continue;
    for (std::size_t i = 0; i < pool.scales.size(); ++i) {
      PooledScale& scale = pool.scales[i];
      scale.people.push_back(pooled_rating((*ratings)[i], items, pair, scale.ends));
    }
  }
  return pool;
}

}  // namespace touchtrial::planning::rating
