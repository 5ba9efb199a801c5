#include "study/course.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace touchtrial::study {

Course::Course(Schedule schedule, OnInterruption policy, DrawBlock draw,
               std::unique_ptr<AdaptiveOrder> order)
    : schedule_(std::move(schedule)),
      policy_(policy),
      draw_(std::move(draw)),
      order_(std::move(order)),
      queue_(schedule_.presentations.size()) {
  if (policy == OnInterruption::restart_block && !draw_) {
    throw std::invalid_argument("Course: a study that restarts blocks needs to draw them");
  }
  if (policy == OnInterruption::restart_block && order_) {
    throw std::invalid_argument("Course: blocks that an order chooses cannot be restarted");
  }
  std::iota(queue_.begin(), queue_.end(), std::size_t{0});
  choose();
}

void Course::choose() {
  if (order_ && !queue_.empty()) order_->choose(schedule_.presentations[queue_.front()]);
}

const Presentation* Course::current() const noexcept {
  return queue_.empty() ? nullptr : &schedule_.presentations[queue_.front()];
}

void Course::finish(std::optional<int> position) {
  if (order_ && position) {
    order_->answer(*current(), schedule_.layout[static_cast<std::size_t>(*position)]);
  }
  queue_.pop_front();
  choose();
}

std::ptrdiff_t Course::places_before_repeats(int block) const {
  if (!order_) return std::ssize(queue_);
  const auto& all = schedule_.presentations;
  const auto is_of_block = [&](std::size_t i) { return all[i].block == block; };
  return std::ranges::find_if_not(queue_, is_of_block) - queue_.begin();
}

void Course::spoil() {
  const std::size_t spoilt = queue_.front();
  if (order_) ++schedule_.presentations[spoilt].interruptions;
  switch (policy_) {
    case OnInterruption::repeat:
      queue_.pop_front();
      queue_.insert(queue_.begin() + places_before_repeats(schedule_.presentations[spoilt].block),
                    spoilt);
      choose();
      return;
    case OnInterruption::leave_out:
      queue_.pop_front();
      choose();
      return;
    case OnInterruption::restart_block:
      to_restart_ = schedule_.presentations[spoilt].block;
      return;
  }
}

BlockRestart Course::drawn_again(int block) const {
  const auto last =
      std::ranges::max_element(schedule_.presentations, {}, &Presentation::trial)->trial;
  const auto before = restarts_.find(block);
  return {block, draw_(block, before == restarts_.end() ? 0 : before->second, last + 1)};
}

void Course::restart(const BlockRestart& again) {
  auto& all = schedule_.presentations;
  std::erase_if(queue_, [&](std::size_t i) { return all[i].block == again.block; });
  for (std::size_t i = again.presentations.size(); i-- > 0;) queue_.push_front(all.size() + i);
  all.insert(all.end(), again.presentations.begin(), again.presentations.end());
  ++restarts_[again.block];
  first_trials_[again.block] = again.first_trial();
  to_restart_.reset();
}

bool Course::was_given_up(int trial) const {
  return std::ranges::any_of(schedule_.presentations, [&](const Presentation& one) {
    const auto restarted = first_trials_.find(one.block);
    return one.trial == trial && restarted != first_trials_.end() && trial < restarted->second;
  });
}

bool Course::has(int trial) const {
  return std::ranges::count(schedule_.presentations, trial, &Presentation::trial) > 0;
}

}  // namespace touchtrial::study
