#include "protocols/design/schedule.hpp"

#include "core/errors.hpp"
#include "core/random.hpp"
#include "protocols/design/block_order.hpp"
#include "protocols/design/catch_trials.hpp"
#include "protocols/design/exemplar_supply.hpp"
#include "protocols/design/order_rules.hpp"
#include "protocols/design/study_names.hpp"

#include <algorithm>
#include <numeric>
#include <span>
#include <stdexcept>

namespace touchtrial::design {
namespace {

/// The methods of each block, and the purpose of its random streams.
struct BlockPlan {
  std::vector<int> methods;
  std::string purpose;
};

std::vector<BlockPlan> block_plans(const Study& study, int enrolment) {
  const std::vector<int> methods = williams_row(study.presented_methods(), enrolment);
  if (study.trials.blocks == Blocks::mixed) {
    std::vector<int> in_file_order(methods.size());
    std::iota(in_file_order.begin(), in_file_order.end(), 0);
    return {{in_file_order, "all methods"}};
  }
  std::vector<BlockPlan> plans;
  for (const int method : methods) plans.push_back({{method}, "method " + std::to_string(method)});
  return plans;
}

/// A block's presentations without catch trials and numbers.
std::vector<Presentation> presentations_of(const BlockOrder& order, int block,
                                           ExemplarSupply& exemplars) {
  std::vector<Presentation> shown;
  for (std::size_t i = 0; i < order.items.size(); ++i) {
    const auto [class_index, method] = order.items[i];
    shown.push_back(
        {.block = block,
         .kind = i < order.lead_ins ? PresentationKind::lead_in : PresentationKind::scored,
         .stimulus = {class_index, exemplars.next(class_index, method), method}});
  }
  return shown;
}

void number(std::vector<Presentation>& presentations, int first) {
  for (Presentation& shown : presentations) shown.trial = first++;
}

std::vector<int> picture_layout(const Study& study, int enrolment) {
  std::vector<int> layout(study.classes.size());
  std::iota(layout.begin(), layout.end(), 0);
  RandomStream random(study.seed, "schedule: layout", static_cast<std::uint64_t>(enrolment));
  shuffle(std::span<int>(layout), random);
  return layout;
}

void check_order(const Study& study) {
  if (const auto obstacle = obstacle_to_order(study)) {
    throw StudyError(
        one_line("study " + study.name + ": /trials" + obstacle->key + ": " + obstacle->what));
  }
}

}  // namespace

Schedule make_schedule(const Study& study, int enrolment) {
  if (enrolment < 1) throw std::invalid_argument("make_schedule: enrolment numbers start at 1");
  check_order(study);
  Schedule schedule;
  ExemplarSupply exemplars(study, enrolment);
  int block = 0;
  for (const auto& [methods, purpose] : block_plans(study, enrolment)) {
    const BlockOrder order = make_block_order(study, methods, purpose, enrolment);
    const auto shown = presentations_of(order, block++, exemplars);
    schedule.presentations.insert(schedule.presentations.end(), shown.begin(), shown.end());
  }
  RandomStream random(study.seed, "schedule: catch", static_cast<std::uint64_t>(enrolment));
  schedule.presentations =
      with_catch_trials(schedule.presentations, study.trials.catch_trials, random);
  number(schedule.presentations, 1);
  schedule.layout = picture_layout(study, enrolment);
  return schedule;
}

std::vector<Presentation> restarted_block(const Study& study, int enrolment, int block,
                                          int restarts_before, int first_trial) {
  const std::vector<BlockPlan> plans = block_plans(study, enrolment);
  if (block < 0 || block >= static_cast<int>(plans.size()) || restarts_before < 0) {
    throw std::invalid_argument("restarted_block: the study has no such block or restart");
  }
  const Schedule first = make_schedule(study, enrolment);
  const auto caught = std::ranges::count_if(first.presentations, [block](const auto& shown) {
    return shown.block == block && shown.kind == PresentationKind::catch_trial;
  });
  const std::string restart = ", restart " + std::to_string(restarts_before + 1);
  const auto& [methods, purpose] = plans[static_cast<std::size_t>(block)];
  ExemplarSupply exemplars(study, enrolment, restart);
  const auto shown = presentations_of(
      make_block_order(study, methods, purpose + restart, enrolment), block, exemplars);
  RandomStream random(study.seed, "schedule: catch, " + purpose + restart,
                      static_cast<std::uint64_t>(enrolment));
  std::vector<Presentation> again = with_catch_trials(shown, static_cast<int>(caught), random);
  number(again, first_trial);
  return again;
}

int williams_rows(int methods) {
  if (methods < 1) throw std::invalid_argument("williams_rows: needs at least one method");
  return methods % 2 == 1 ? 2 * methods : methods;
}

std::vector<int> williams_row(int methods, int enrolment) {
  if (methods < 1) throw std::invalid_argument("williams_row: needs at least one method");
  if (enrolment < 0) throw std::invalid_argument("williams_row: enrolment cannot be negative");
  const bool odd = methods % 2 == 1;
  const int row = enrolment % williams_rows(methods);
  std::vector<int> order;
  for (int i = 0; i < methods; ++i) {
    // 0, 1, m-1, 2, m-2, ..: the differences of neighbours are all different modulo m.
    const int first_row = i % 2 == 1 ? (i + 1) / 2 : (methods - i / 2) % methods;
    order.push_back((first_row + row) % methods);
  }
  // An odd square is unbalanced alone; its mirror image has the missing neighbours.
  if (odd && row >= methods) return {order.rbegin(), order.rend()};
  return order;
}

std::string schedule_rule(const Study& study) {
  std::string exemplars;
  for (const StudyClass& study_class : study.classes) {
    exemplars += (exemplars.empty() ? "" : ",") + std::to_string(study_class.images.size());
  }
  const TrialOptions& trials = study.trials;
  return "touchtrial schedule 1: mt19937_64 streams by SHA-256(seed, purpose, enrolment)"
         "; classes=" +
         std::to_string(study.classes.size()) + "; exemplars=" + exemplars +
         "; methods=" + std::to_string(study.presented_methods()) +
         "; repeats=" + std::to_string(trials.repeats) +
         "; order=" + std::string(word_for(kTrialOrderNames, trials.order)) +
         "; blocks=" + std::string(word_for(kBlocksNames, trials.blocks)) +
         "; lead_in=" + std::to_string(trials.lead_in) +
         (trials.max_run > 0 ? "; max_run=" + std::to_string(trials.max_run) : "") +
         (trials.catch_trials > 0 ? "; catch=" + std::to_string(trials.catch_trials) : "");
}

}  // namespace touchtrial::design
