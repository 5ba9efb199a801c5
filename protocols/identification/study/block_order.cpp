#include "protocols/identification/study/block_order.hpp"

#include "core/errors.hpp"
#include "core/random.hpp"
#include "study/random_orders.hpp"

namespace touchtrial::study::identification {
namespace {

int classes_of(const Study& study) {
  return static_cast<int>(study.classes.size());
}

/// The number of scored presentations of a class in one block.
int copies_in_block(const Study& study) {
  const int methods = study.trials.blocks == Blocks::mixed ? study.presented_methods() : 1;
  return study.trials.repeats * methods;
}

bool mixes_methods(const Study& study) {
  return study.trials.blocks == Blocks::mixed && study.presented_methods() > 1;
}

/// Whether the limit on runs excludes any order.
bool limits_runs(const Study& study) {
  const TrialOptions& trials = study.trials;
  if (trials.max_run == 0) return false;
  const int copies = trials.order == TrialOrder::uniform
                         ? classes_of(study) * copies_in_block(study)
                         : copies_in_block(study);
  return trials.max_run < copies + trials.lead_in;
}

std::optional<OrderObstacle> obstacle_to_de_bruijn(const Study& study) {
  const int classes = classes_of(study);
  if (study.trials.repeats != classes) {
    return OrderObstacle{
        "/repeats", "is " + std::to_string(study.trials.repeats) +
                        ", but the order de-bruijn needs as many repeats as classes; set it to " +
                        std::to_string(classes)};
  }
  if (study.trials.lead_in != 0) {
    return OrderObstacle{
        "/lead_in", "must be 0, because the order de-bruijn adds one lead-in presentation itself"};
  }
  if (mixes_methods(study)) {
    return OrderObstacle{
        "/blocks",
        "must be \"by-method\", because the order de-bruijn balances classes within "
        "one method"};
  }
  if (study.trials.max_run == 1) {
    return OrderObstacle{
        "/max_run",
        "is 1, but in the order de-bruijn every class follows itself once; use 2 or "
        "more, or choose the order shuffled"};
  }
  return std::nullopt;
}

std::optional<OrderObstacle> obstacle_to_williams(const Study& study) {
  const TrialOptions& trials = study.trials;
  if (mixes_methods(study)) {
    return OrderObstacle{
        "/blocks",
        "must be \"by-method\", because the order williams balances classes within "
        "one method"};
  }
  if (trials.max_run > 0 &&
      !williams_order_exists(classes_of(study), trials.repeats, trials.max_run)) {
    return OrderObstacle{
        "/max_run",
        "is 1, but no order williams of 2 classes has runs that short, because its "
        "two rows mirror each other; use 2 or more, or choose the order shuffled"};
  }
  return std::nullopt;
}

std::optional<OrderObstacle> obstacle_to_limit(const Study& study) {
  if (study.trials.order != TrialOrder::shuffled || !limits_runs(study)) return std::nullopt;
  const std::vector<int> counts(study.classes.size(), copies_in_block(study));
  const std::string limit = "is " + std::to_string(study.trials.max_run);
  if (!limited_order_exists(counts, study.trials.max_run)) {
    return OrderObstacle{"/max_run", limit + ", which no order satisfies; raise it"};
  }
  if (!limited_orders_are_countable(counts, study.trials.max_run)) {
    return OrderObstacle{
        "/max_run", limit + ", but the orders of " + std::to_string(counts.size()) +
                        " classes presented " + std::to_string(counts.front()) +
                        " times in a block are too many to count; use fewer classes or repeats, "
                        "blocks by method, another order, or 0"};
  }
  return std::nullopt;
}

/// The inputs for drawing a block, with its random streams.
struct BlockDraw {
  const Study& study;
  std::vector<BlockItem> items;  ///< every pair of class and method once, method by method
  RandomStream order;
  RandomStream lead_in;

  [[nodiscard]] int classes() const { return static_cast<int>(study.classes.size()); }
  [[nodiscard]] int methods() const { return static_cast<int>(items.size()) / classes(); }
  [[nodiscard]] int scored_count() const {
    return static_cast<int>(items.size()) * study.trials.repeats;
  }
  [[nodiscard]] const BlockItem& item(int class_index, int method) const {
    return items[static_cast<std::size_t>(method * classes() + class_index)];
  }
};

std::vector<BlockItem> items_of(const Study& study, std::span<const int> methods) {
  std::vector<BlockItem> items;
  for (const int method : methods) {
    for (int c = 0; c < static_cast<int>(study.classes.size()); ++c) items.push_back({c, method});
  }
  return items;
}

BlockItem random_item(std::span<const BlockItem> items, RandomStream& random) {
  return items[static_cast<std::size_t>(random.below(items.size()))];
}

/// A de Bruijn cycle preceded by its last symbol as a lead-in, so that every transition occurs.
BlockOrder de_bruijn_order(BlockDraw& draw) {
  const std::vector<int> cycle =
      random_de_bruijn_cycle(static_cast<int>(draw.items.size()), draw.order);
  BlockOrder order{{draw.items[static_cast<std::size_t>(cycle.back())]}, 1};
  for (const int symbol : cycle) {
    order.items.push_back(draw.items[static_cast<std::size_t>(symbol)]);
  }
  return order;
}

/// An order without a limit on runs: independent draws for the order `uniform`, otherwise every
/// item equally often in a shuffled order.
std::vector<BlockItem> unlimited_order(BlockDraw& draw) {
  const bool is_balanced = draw.study.trials.order == TrialOrder::shuffled;
  std::vector<BlockItem> scored;
  for (int i = 0; i < draw.scored_count(); ++i) {
    const auto next = static_cast<std::size_t>(i) % draw.items.size();
    scored.push_back(is_balanced ? draw.items[next] : random_item(draw.items, draw.order));
  }
  if (is_balanced) shuffle(std::span<BlockItem>(scored), draw.order);
  return scored;
}

/// Assigns an independently drawn method to each presentation.
std::vector<BlockItem> assign_random_methods(const std::vector<int>& classes, const BlockDraw& draw,
                                             RandomStream& random) {
  std::vector<BlockItem> items;
  for (const int class_index : classes) {
    const auto method = random.below(static_cast<std::uint64_t>(draw.methods()));
    items.push_back(draw.item(class_index, static_cast<int>(method)));
  }
  return items;
}

/// Assigns every method equally often to each class, in shuffled order. Every order of classes has
/// the same number of method orders, so all combinations are equally likely.
std::vector<BlockItem> assign_balanced_methods(const std::vector<int>& classes, BlockDraw& draw) {
  std::vector<std::vector<int>> decks(static_cast<std::size_t>(draw.classes()));
  for (std::vector<int>& deck : decks) {
    for (int i = 0; i < draw.study.trials.repeats * draw.methods(); ++i) {
      deck.push_back(i % draw.methods());
    }
    shuffle(std::span<int>(deck), draw.order);
  }
  std::vector<BlockItem> items;
  for (const int class_index : classes) {
    std::vector<int>& deck = decks[static_cast<std::size_t>(class_index)];
    items.push_back(draw.item(class_index, deck.back()));
    deck.pop_back();
  }
  return items;
}

std::vector<BlockItem> limited_order(BlockDraw& draw, PrecedingRun previous_run) {
  const int max_run = draw.study.trials.max_run;
  if (draw.study.trials.order == TrialOrder::uniform) {
    const std::vector<int> classes = draw_limited_sequence(draw.classes(), draw.scored_count(),
                                                           max_run, previous_run, draw.order);
    return assign_random_methods(classes, draw, draw.order);
  }
  const std::vector<int> counts(static_cast<std::size_t>(draw.classes()),
                                draw.study.trials.repeats * draw.methods());
  const auto classes = draw_limited_order(counts, max_run, previous_run, draw.order);
  if (!classes) {
    throw StudyError(one_line("study " + draw.study.name + ": /trials/max_run: is " +
                              std::to_string(max_run) + ", which no order satisfies; raise it"));
  }
  return assign_balanced_methods(*classes, draw);
}

std::vector<BlockItem> williams_order(BlockDraw& draw, PrecedingRun previous_run) {
  const TrialOptions& trials = draw.study.trials;
  std::vector<BlockItem> items;
  for (const int class_index : random_williams_order(draw.classes(), trials.repeats, trials.max_run,
                                                     previous_run, draw.order)) {
    items.push_back(draw.item(class_index, 0));
  }
  return items;
}

/// Draws the lead-in presentations before the scored presentations, which continue the last run.
std::vector<BlockItem> draw_lead_ins(BlockDraw& draw) {
  const TrialOptions& trials = draw.study.trials;
  if (trials.max_run > 0) {
    const std::vector<int> classes =
        draw_limited_sequence(draw.classes(), trials.lead_in, trials.max_run, {}, draw.lead_in);
    return assign_random_methods(classes, draw, draw.lead_in);
  }
  std::vector<BlockItem> items;
  for (int i = 0; i < trials.lead_in; ++i) items.push_back(random_item(draw.items, draw.lead_in));
  return items;
}

PrecedingRun run_after(const std::vector<BlockItem>& items) {
  std::vector<int> classes;
  for (const BlockItem& item : items) classes.push_back(item.class_index);
  return run_at_end(classes, {});
}

std::vector<BlockItem> scored_items(BlockDraw& draw, PrecedingRun previous_run) {
  if (draw.study.trials.order == TrialOrder::williams) return williams_order(draw, previous_run);
  return limits_runs(draw.study) ? limited_order(draw, previous_run) : unlimited_order(draw);
}

}  // namespace

std::optional<OrderObstacle> obstacle_to_order(const Study& study) {
  if (study.trials.order == TrialOrder::de_bruijn) return obstacle_to_de_bruijn(study);
  if (study.trials.order == TrialOrder::williams) return obstacle_to_williams(study);
  return obstacle_to_limit(study);
}

BlockOrder make_block_order(const Study& study, std::span<const int> methods,
                            const std::string& purpose, const SecretKey& secret) {
  BlockDraw draw{study, items_of(study, methods),
                 RandomStream(secret, "schedule: order, " + purpose),
                 RandomStream(secret, "schedule: lead-in, " + purpose)};
  if (study.trials.order == TrialOrder::de_bruijn) return de_bruijn_order(draw);
  BlockOrder order;
  order.items = draw_lead_ins(draw);
  order.lead_ins = order.items.size();
  const std::vector<BlockItem> scored = scored_items(draw, run_after(order.items));
  order.items.insert(order.items.end(), scored.begin(), scored.end());
  return order;
}

}  // namespace touchtrial::study::identification
