#include "protocols/design/schedule.hpp"

#include "core/errors.hpp"
#include "core/random.hpp"
#include "protocols/design/de_bruijn.hpp"
#include "protocols/design/exemplar_supply.hpp"
#include "protocols/design/order_rules.hpp"
#include "protocols/design/study_names.hpp"

#include <numeric>
#include <span>
#include <stdexcept>

namespace touchtrial {
namespace {

/// What a trial presents before an image is chosen.
struct Item {
  int class_index = 0;
  int method = 0;
};

/// A block's presentations; the first `lead_ins` are not scored.
struct BlockOrder {
  std::vector<Item> items;
  std::size_t lead_ins = 0;
};

std::vector<Item> items_of(const Study& study, std::span<const int> methods) {
  std::vector<Item> items;
  for (const int method : methods) {
    for (int c = 0; c < static_cast<int>(study.classes.size()); ++c) items.push_back({c, method});
  }
  return items;
}

Item drawn(std::span<const Item> items, RandomStream& random) {
  return items[static_cast<std::size_t>(random.below(items.size()))];
}

/// The cycle with its last symbol before it, so that every transition has both its ends.
BlockOrder de_bruijn_order(std::span<const Item> items, RandomStream& random) {
  const std::vector<int> cycle = random_de_bruijn_cycle(static_cast<int>(items.size()), random);
  BlockOrder order{{items[static_cast<std::size_t>(cycle.back())]}, 1};
  for (const int symbol : cycle) order.items.push_back(items[static_cast<std::size_t>(symbol)]);
  return order;
}

std::vector<Item> scored_items(std::span<const Item> items, const TrialOptions& trials,
                               RandomStream& random) {
  const std::size_t count = items.size() * static_cast<std::size_t>(trials.repeats);
  std::vector<Item> scored;
  for (std::size_t i = 0; i < count; ++i) {
    const bool balanced = trials.order == TrialOrder::shuffled;
    scored.push_back(balanced ? items[i % items.size()] : drawn(items, random));
  }
  if (trials.order == TrialOrder::shuffled) shuffle(std::span<Item>(scored), random);
  return scored;
}

/// \param purpose  of the block's random streams
BlockOrder block_order(const Study& study, std::span<const int> methods, const std::string& purpose,
                       int enrolment) {
  const std::vector<Item> items = items_of(study, methods);
  const auto index = static_cast<std::uint64_t>(enrolment);
  RandomStream random(study.seed, "schedule: order, " + purpose, index);
  if (study.trials.order == TrialOrder::de_bruijn) return de_bruijn_order(items, random);
  RandomStream lead_in_random(study.seed, "schedule: lead-in, " + purpose, index);
  BlockOrder order;
  order.lead_ins = static_cast<std::size_t>(study.trials.lead_in);
  for (std::size_t i = 0; i < order.lead_ins; ++i) {
    order.items.push_back(drawn(items, lead_in_random));
  }
  const std::vector<Item> scored = scored_items(items, study.trials, random);
  order.items.insert(order.items.end(), scored.begin(), scored.end());
  return order;
}

std::vector<BlockOrder> all_blocks(const Study& study, int enrolment) {
  const std::vector<int> methods = williams_row(study.presented_methods(), enrolment);
  if (study.trials.blocks == Blocks::mixed) {
    std::vector<int> in_file_order(methods.size());
    std::iota(in_file_order.begin(), in_file_order.end(), 0);
    return {block_order(study, in_file_order, "all methods", enrolment)};
  }
  std::vector<BlockOrder> blocks;
  for (const int method : methods) {
    const std::string purpose = "method " + std::to_string(method);
    blocks.push_back(block_order(study, std::span(&method, 1), purpose, enrolment));
  }
  return blocks;
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
  for (const BlockOrder& order : all_blocks(study, enrolment)) {
    for (std::size_t i = 0; i < order.items.size(); ++i) {
      const auto [class_index, method] = order.items[i];
      schedule.presentations.push_back(
          {.trial = static_cast<int>(schedule.presentations.size()) + 1,
           .block = block,
           .kind = i < order.lead_ins ? PresentationKind::lead_in : PresentationKind::scored,
           .stimulus = {class_index, exemplars.next(class_index, method), method}});
    }
    ++block;
  }
  schedule.layout = picture_layout(study, enrolment);
  return schedule;
}

std::vector<int> williams_row(int methods, int enrolment) {
  if (methods < 1) throw std::invalid_argument("williams_row: needs at least one method");
  if (enrolment < 0) throw std::invalid_argument("williams_row: enrolment cannot be negative");
  const bool odd = methods % 2 == 1;
  const int row = enrolment % (odd ? 2 * methods : methods);
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
         "; lead_in=" + std::to_string(trials.lead_in);
}

}  // namespace touchtrial
