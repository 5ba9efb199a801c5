#include "study/course.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace touchtrial::study {

Course::Course(std::unique_ptr<Order> order, OnInterruption policy)
    : order_(std::move(order)),
      schedule_(order_->schedule()),
      policy_(policy),
      queue_(schedule_.trials.size()) {
  if (policy == OnInterruption::restart_block && order_->is_adaptive()) {
    throw std::invalid_argument("Course: blocks of an adaptive order cannot be restarted");
  }
  std::iota(queue_.begin(), queue_.end(), std::size_t{0});
  choose_planes();
}

void Course::choose_planes() {
  current_.reset();
  if (!queue_.empty()) current_ = order_->at(schedule_.trials[queue_.front()]);
}

void Course::finish(const std::optional<Answer>& answer) {
  if (answer) order_->answered(*current_, *answer);
  queue_.pop_front();
  choose_planes();
}

std::ptrdiff_t Course::places_before_repeats(int block) const {
  if (!order_->is_adaptive()) return std::ssize(queue_);
  const auto& trials = schedule_.trials;
  const auto is_of_block = [&](std::size_t i) { return trials[i].place.block == block; };
  return std::ranges::find_if_not(queue_, is_of_block) - queue_.begin();
}

void Course::interrupt() {
  const std::size_t interrupted = queue_.front();
  order_->interrupted(*current_);
  switch (policy_) {
    case OnInterruption::repeat:
      queue_.pop_front();
      queue_.insert(queue_.begin() + places_before_repeats(current_->place.block), interrupted);
      choose_planes();
      return;
    case OnInterruption::leave_out:
      queue_.pop_front();
      choose_planes();
      return;
    case OnInterruption::restart_block:
      block_to_restart_ = current_->place.block;
      return;
  }
}

BlockRestart Course::redrawn_block(int block) const {
  const auto number = [](const Trial& trial) { return trial.place.trial; };
  const int last_number = number(*std::ranges::max_element(schedule_.trials, {}, number));
  const auto restarts = restarts_.find(block);
  return {block, order_->redraw_block(block, restarts == restarts_.end() ? 0 : restarts->second,
                                      last_number + 1)};
}

void Course::restart(const BlockRestart& restarted) {
  auto& trials = schedule_.trials;
  std::erase_if(queue_, [&](std::size_t i) { return trials[i].place.block == restarted.block; });
  for (std::size_t i = restarted.trials.size(); i-- > 0;) queue_.push_front(trials.size() + i);
  trials.insert(trials.end(), restarted.trials.begin(), restarted.trials.end());
  ++restarts_[restarted.block];
  first_trials_[restarted.block] = restarted.first_trial();
  block_to_restart_.reset();
  choose_planes();
}

bool Course::is_void(int trial) const {
  return std::ranges::any_of(schedule_.trials, [&](const Trial& scheduled) {
    const auto first = first_trials_.find(scheduled.place.block);
    return scheduled.place.trial == trial && first != first_trials_.end() && trial < first->second;
  });
}

bool Course::has_trial(int trial) const {
  return std::ranges::any_of(
      schedule_.trials, [&](const Trial& scheduled) { return scheduled.place.trial == trial; });
}

}  // namespace touchtrial::study
