/// \file The day sheet, ticked item by item.
#pragma once

#include "protocols/session/experimenter.hpp"

#include <string>
#include <vector>

namespace touchtrial::app {

/// Enter or y: done; s: skipped, a deviation; b: back to the item before. Not thread-safe.
class TickList {
 public:
  explicit TickList(std::vector<session::DaySheetItem> items);

  void take(char key);
  /// The item that is asked for now, and how; empty once all are ticked.
  [[nodiscard]] std::string text() const;
  [[nodiscard]] std::string prompt() const;
  [[nodiscard]] bool is_done() const noexcept { return ticks_.size() == items_.size(); }
  /// In the items' order, as far as they are ticked.
  [[nodiscard]] const std::vector<session::Tick>& ticks() const noexcept { return ticks_; }

 private:
  std::vector<session::DaySheetItem> items_;
  std::vector<session::Tick> ticks_;
};

}  // namespace touchtrial::app
