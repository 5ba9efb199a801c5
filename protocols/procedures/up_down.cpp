#include "protocols/procedures/kinds.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace touchtrial::procedures {
namespace {

void require_rule(const UpDown& rule) {
  const bool has_steps = !rule.steps_down.empty() &&
                         std::all_of(rule.steps_down.begin(), rule.steps_down.end(),
                                     [](int step) { return step >= 1 && step <= 1'000'000; });
  const bool has_counts = rule.correct_for_down >= 1 && rule.wrong_for_up >= 1;
  if (!has_steps || !has_counts || rule.up_for_one_down < 1 || rule.up_for_one_down > 1'000) {
    throw std::invalid_argument("a staircase needs steps and counts of at least 1");
  }
}

class Staircase final : public Procedure {
 public:
  Staircase(UpDown rule, std::size_t levels)
      : rule_(std::move(rule)), top_(levels - 1), level_(rule_.first_level) {
    require_rule(rule_);
    if (level_ > top_)
      throw std::invalid_argument("a staircase's first level must be one of the track's levels");
  }

  [[nodiscard]] std::size_t next() const override { return level_; }

  void answer(bool correct) override {
    if (correct != run_is_correct_) run_length_ = 0;
    run_is_correct_ = correct;
    if (++run_length_ < (correct ? rule_.correct_for_down : rule_.wrong_for_up)) return;
    run_length_ = 0;
    move(correct);
  }

 private:
  enum class Direction { none, up, down };

  void move(bool down) {
    const Direction direction = down ? Direction::down : Direction::up;
    if (last_direction_ != Direction::none && last_direction_ != direction &&
        step_ + 1 < rule_.steps_down.size())
      ++step_;
    last_direction_ = direction;
    const auto step = static_cast<std::size_t>(rule_.steps_down[step_]);
    if (down) {
      level_ -= std::min(level_, step);
    } else {
      level_ = std::min(top_, level_ + step * static_cast<std::size_t>(rule_.up_for_one_down));
    }
  }

  UpDown rule_;
  std::size_t top_;
  std::size_t level_;
  std::size_t step_ = 0;  ///< index of the step size
  int run_length_ = 0;
  bool run_is_correct_ = false;
  Direction last_direction_ = Direction::none;
};

}  // namespace

double convergence_of(const UpDown& rule) {
  require_rule(rule);
  const double up = rule.up_for_one_down;
  if (rule.wrong_for_up == 1) return std::pow(up / (1.0 + up), 1.0 / rule.correct_for_down);
  if (rule.correct_for_down == 1) return 1.0 - std::pow(1.0 / (1.0 + up), 1.0 / rule.wrong_for_up);
  throw std::invalid_argument("convergence_of: one of the two counts must be 1");
}

std::unique_ptr<Procedure> make_up_down(const TrackSettings& settings, RandomStream& /*stream*/) {
  return std::make_unique<Staircase>(settings.up_down, settings.levels.size());
}

std::unique_ptr<Procedure> make_weighted_up_down(const TrackSettings& settings,
                                                 RandomStream& stream) {
  if (settings.up_down.correct_for_down != 1 || settings.up_down.wrong_for_up != 1) {
    throw std::invalid_argument(
        "a weighted staircase moves after each answer: both counts must be 1");
  }
  return make_up_down(settings, stream);
}

}  // namespace touchtrial::procedures
