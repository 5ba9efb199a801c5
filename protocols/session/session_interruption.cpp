// What becomes of a presentation that was spoilt.
#include "protocols/session/session.hpp"

#include <algorithm>
#include <utility>

namespace touchtrial::session {

void Session::give_up_presentation(Time at) {
  const std::size_t spoilt = queue_.front();
  queue_.pop_front();
  evidence_.reset();
  switch (options_.on_interruption) {
    case design::OnInterruption::repeat:
      queue_.push_back(spoilt);
      break;
    case design::OnInterruption::leave_out:
      break;
    case design::OnInterruption::restart_block:
      queue_.push_front(spoilt);
      block_to_restart_ = schedule_.presentations[spoilt].block;
      break;
  }
  move_to(queue_.empty() ? SessionPhase::finished : SessionPhase::ready, at);
}

std::vector<design::Presentation> Session::drawn_again(int block, int first_trial) {
  return restart_.draw(block, restarts_[block], first_trial);
}

/// New numbers, so that nothing in clear links two presentations of one stimulus.
void Session::restart_block(Time at) {
  const int block = *block_to_restart_;
  const int first_trial =
      std::ranges::max_element(schedule_.presentations, {}, &design::Presentation::trial)->trial +
      1;
  std::vector<design::Presentation> presentations = drawn_again(block, first_trial);
  recorder_.block_restarted(at, block, first_trial, restart_.secret(presentations));
  replace_block(block, std::move(presentations));
  move_to(phase_, at);
}

void Session::replace_block(int block, std::vector<design::Presentation> presentations) {
  std::erase_if(queue_, [&](std::size_t i) { return schedule_.presentations[i].block == block; });
  for (auto next = presentations.rbegin(); next != presentations.rend(); ++next) {
    schedule_.presentations.push_back(*next);
    queue_.push_front(schedule_.presentations.size() - 1);
  }
  ++restarts_[block];
  done_since_break_ = 0;
  block_to_restart_.reset();
}

}  // namespace touchtrial::session
