#include "protocols/identification/study/schedule.hpp"

#include "core/errors.hpp"
#include "core/random.hpp"
#include "core/strict_json.hpp"
#include "protocols/identification/study/block_order.hpp"
#include "study/random_orders.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <numeric>
#include <span>
#include <stdexcept>
#include <utility>

namespace touchtrial::study::identification {
namespace {

/// The methods of a block, and the suffix of its random streams' names.
struct BlockPlan {
  std::vector<int> methods;
  std::string purpose;
};

std::vector<BlockPlan> block_plans(const Study& study, const ScheduleDraw& draw) {
  const std::vector<int> methods = williams_row(study.presented_methods(), draw.method_order);
  if (study.trials.blocks == Blocks::mixed) {
    std::vector<int> file_order(methods.size());
    std::iota(file_order.begin(), file_order.end(), 0);
    return {{file_order, "all methods"}};
  }
  std::vector<BlockPlan> plans;
  for (const int method : methods) plans.push_back({{method}, "method " + std::to_string(method)});
  return plans;
}

/// Chooses images for one participant. For each class and method, all images are used in random
/// order before any repeats; then they are reshuffled.
class ExemplarSupply {
 public:
  /// \param restart  suffix of the random streams' names; empty for a schedule's initial order
  ExemplarSupply(const Study& study, const ScheduleDraw& draw, std::string restart = {})
      : study_(study), secret_(draw.secret), restart_(std::move(restart)) {}

  /// \return the index of the next image of the class for the method
  int next(int class_index, int method);

 private:
  struct Deck {
    RandomStream random;
    std::vector<int> remaining;  ///< remaining images; the next one is at the back
  };

  const Study& study_;
  SecretKey secret_;
  std::string restart_;
  std::map<std::pair<int, int>, Deck> decks_;
};

int ExemplarSupply::next(int class_index, int method) {
  const std::size_t images = study_.classes[static_cast<std::size_t>(class_index)].images.size();
  if (images == 1) return 0;
  const auto key = std::pair(class_index, method);
  auto deck = decks_.find(key);
  if (deck == decks_.end()) {
    const std::string purpose = "schedule: exemplars of class " + std::to_string(class_index) +
                                ", method " + std::to_string(method) + restart_;
    deck = decks_.emplace(key, Deck{RandomStream(secret_, purpose), {}}).first;
  }
  std::vector<int>& remaining = deck->second.remaining;
  if (remaining.empty()) {
    remaining.resize(images);
    std::iota(remaining.begin(), remaining.end(), 0);
    shuffle(std::span<int>(remaining), deck->second.random);
  }
  const int exemplar = remaining.back();
  remaining.pop_back();
  return exemplar;
}

/// Draws `count` of `places` places, except the first.
/// \return for each place, whether it was drawn
std::vector<bool> random_places(std::size_t places, std::size_t count, RandomStream& random) {
  std::vector<std::size_t> candidates(places - 1);
  std::iota(candidates.begin(), candidates.end(), std::size_t{1});
  shuffle(std::span<std::size_t>(candidates), random);
  std::vector<bool> drawn_places(places, false);
  for (std::size_t i = 0; i < count; ++i) drawn_places[candidates[i]] = true;
  return drawn_places;
}

/// Inserts catch trials at random places after the first trial, each choice of places equally
/// likely. A catch trial belongs to the block of the preceding presentation. Does not number
/// trials.
/// \pre `presentations` is not empty if `count` > 0
std::vector<Trial> with_catch_trials(const std::vector<Trial>& presentations, int count,
                                     RandomStream& random) {
  if (count == 0) return presentations;
  const auto catches = static_cast<std::size_t>(count);
  std::vector<Trial> all;
  auto next = presentations.begin();
  for (const bool is_catch : random_places(presentations.size() + catches, catches, random)) {
    if (is_catch) {
      Trial& blank = all.emplace_back();
      blank.place.block = all[all.size() - 2].place.block;
      blank.role = Role::catch_trial;
      blank.planes.push_back({.field = {}, .blank = true});
    } else {
      all.push_back(*next++);
    }
  }
  return all;
}

/// A block's presentations, without catch trials and trial numbers.
std::vector<Trial> presentations_of(const BlockOrder& order, int block, ExemplarSupply& exemplars) {
  std::vector<Trial> presentations;
  for (std::size_t i = 0; i < order.items.size(); ++i) {
    const auto [class_index, method] = order.items[i];
    Trial& trial = presentations.emplace_back();
    trial.place.block = block;
    trial.role = i < order.lead_ins ? Role::lead_in : Role::scored;
    trial.planes.push_back({.field = {class_index, exemplars.next(class_index, method), method}});
    trial.right = class_index;
  }
  return presentations;
}

void number_trials(std::vector<Trial>& trials, int first) {
  for (Trial& trial : trials) trial.place.trial = first++;
}

/// Roves gains downwards from the pack's gain, so that no presentation exceeds it. Catch trials are
/// not roved.
void rove(const Study& study, RandomStream random, std::vector<Trial>& trials) {
  if (study.trials.rove_db == 0.0) return;
  for (Trial& trial : trials) {
    if (trial.role == Role::catch_trial) continue;
    trial.planes.front().gain_db =
        study.trials.centre_gain_db() + draw_rove_db(study.trials.rove_db, random);
  }
}

/// Removes other visits' blocks if the study divides its methods between visits. The remaining
/// blocks keep their numbers.
void keep_trials_of_visit(const Study& study, int visit, std::vector<Trial>& trials) {
  if (visit == 0 || study.visits.methods != VisitMethods::divided) return;
  const int blocks = study.presented_methods() / study.visits.count;
  std::erase_if(trials, [&](const Trial& one) { return one.place.block / blocks + 1 != visit; });
}

std::vector<int> picture_layout(const Study& study, const ScheduleDraw& draw) {
  std::vector<int> layout(study.classes.size());
  std::iota(layout.begin(), layout.end(), 0);
  RandomStream random(draw.secret, "schedule: layout");
  shuffle(std::span<int>(layout), random);
  return layout;
}

void check_order(const Study& study) {
  if (const auto obstacle = obstacle_to_order(study)) {
    throw StudyError(
        one_line("study " + study.name + ": /trials" + obstacle->key + ": " + obstacle->what));
  }
}

Schedule draw_schedule(const Study& study, const ScheduleDraw& draw) {
  check_order(study);
  Schedule schedule;
  ExemplarSupply exemplars(study, draw);
  int block = 0;
  for (const auto& [methods, purpose] : block_plans(study, draw)) {
    const BlockOrder order = make_block_order(study, methods, purpose, draw.secret);
    const auto presentations = presentations_of(order, block++, exemplars);
    schedule.trials.insert(schedule.trials.end(), presentations.begin(), presentations.end());
  }
  RandomStream random(draw.secret, "schedule: catch");
  schedule.trials = with_catch_trials(schedule.trials, study.trials.catch_trials, random);
  rove(study, RandomStream(draw.secret, "schedule: rove"), schedule.trials);
  keep_trials_of_visit(study, draw.visit, schedule.trials);
  number_trials(schedule.trials, 1);
  schedule.layout = picture_layout(study, draw);
  return schedule;
}

std::vector<Trial> draw_restarted_block(const Study& study, const ScheduleDraw& draw, int block,
                                        int restarts_before, int first_trial) {
  const std::vector<BlockPlan> plans = block_plans(study, draw);
  if (block < 0 || block >= static_cast<int>(plans.size()) || restarts_before < 0) {
    throw std::invalid_argument("Order: the schedule has no such block or restart");
  }
  const Schedule initial = draw_schedule(study, draw);
  const auto catches = std::ranges::count_if(initial.trials, [block](const Trial& trial) {
    return trial.place.block == block && trial.role == Role::catch_trial;
  });
  const std::string restart = ", restart " + std::to_string(restarts_before + 1);
  const auto& [methods, purpose] = plans[static_cast<std::size_t>(block)];
  ExemplarSupply exemplars(study, draw, restart);
  const auto presentations = presentations_of(
      make_block_order(study, methods, purpose + restart, draw.secret), block, exemplars);
  RandomStream random(draw.secret, "schedule: catch, " + purpose + restart);
  std::vector<Trial> restarted =
      with_catch_trials(presentations, static_cast<int>(catches), random);
  rove(study, RandomStream(draw.secret, "schedule: rove, " + purpose + restart), restarted);
  number_trials(restarted, first_trial);
  return restarted;
}

class IdentifyingOrder final : public Order {
 public:
  IdentifyingOrder(const Study& study, const ScheduleDraw& draw)
      : Order(draw_schedule(study, draw), draw.secret), study_(study), draw_(draw) {}

  std::vector<Trial> redraw_block(int block, int restarts_before, int first_trial) const override {
    return draw_restarted_block(study_, draw_, block, restarts_before, first_trial);
  }

 private:
  const Study& study_;
  ScheduleDraw draw_;
};

}  // namespace

std::unique_ptr<Order> identifying_order(const Study& study, const ScheduleDraw& draw) {
  return std::make_unique<IdentifyingOrder>(study, draw);
}

std::string rule_of_schedule(const Study& study) {
  std::string exemplars;
  for (const StudyClass& study_class : study.classes) {
    exemplars += (exemplars.empty() ? "" : ",") + std::to_string(study_class.images.size());
  }
  const TrialOptions& trials = study.trials;
  return "touchtrial schedule 2: mt19937_64 streams by BLAKE2b(participant's secret, purpose)"
         "; classes=" +
         std::to_string(study.classes.size()) + "; exemplars=" + exemplars +
         "; methods=" + std::to_string(study.presented_methods()) +
         "; repeats=" + std::to_string(trials.repeats) +
         "; order=" + std::string(name_of(trials.order)) +
         "; blocks=" + std::string(name_of(trials.blocks)) +
         "; lead_in=" + std::to_string(trials.lead_in) +
         (trials.max_run > 0 ? "; max_run=" + std::to_string(trials.max_run) : "") +
         (trials.rove_db > 0.0 ? "; rove_db=" + number_text(trials.rove_db) : "") +
         (trials.catch_trials > 0 ? "; catch=" + std::to_string(trials.catch_trials) : "") +
         (study.visits.count > 1 ? "; visits=" + std::to_string(study.visits.count) : "") +
         (study.groups.labels.empty() ? ""
                                      : "; groups=" + std::to_string(study.groups.labels.size()));
}

}  // namespace touchtrial::study::identification
