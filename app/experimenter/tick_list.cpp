#include "app/experimenter/tick_list.hpp"

#include <utility>

#include <fmt/format.h>

namespace touchtrial::app {

TickList::TickList(std::vector<session::DaySheetItem> items) : items_(std::move(items)) {}

void TickList::take(char key) {
  if (key == 'b' && !ticks_.empty()) {
    ticks_.pop_back();
    return;
  }
  if (is_done()) return;
  if (key == '\n' || key == '\r' || key == 'y') {
    ticks_.push_back(session::Tick::done);
  } else if (key == 's') {
    ticks_.push_back(session::Tick::skipped);
  }
}

std::string TickList::text() const {
  if (is_done()) return "";
  return fmt::format("{}/{} {}", ticks_.size() + 1, items_.size(), items_[ticks_.size()].text);
}

std::string TickList::prompt() const {
  if (is_done()) return "";
  return fmt::format("Enter: done, s: skip ({}), b: back ", items_[ticks_.size()].code);
}

}  // namespace touchtrial::app
