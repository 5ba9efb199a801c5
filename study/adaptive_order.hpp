/// \file Orders in which the answers so far decide what comes next. Source: docs/thresholds.md.
#pragma once

#include "study/schedule.hpp"

namespace touchtrial::study {

/// A state machine that a protocol makes for each participant: what it chooses is a function of the
/// participant's draw and of the answers that it was told, and so a session that is taken up again,
/// and the check of its record, choose the same. Not thread-safe.
class AdaptiveOrder {
 public:
  virtual ~AdaptiveOrder() = default;
  AdaptiveOrder() = default;
  AdaptiveOrder(const AdaptiveOrder&) = delete;
  AdaptiveOrder& operator=(const AdaptiveOrder&) = delete;

  /// Chooses what comes next: the same until the next answer.
  /// \param presentation  its trial stays; all else may be set. Its block is in clear, and so must
  ///   follow from how many answers there were, never from what they were
  virtual void choose(Presentation& presentation) const = 0;
  /// The answer to what was chosen last.
  /// \param shown  as `choose` made it
  /// \param choice  index into the protocol's choices
  virtual void answer(const Presentation& shown, int choice) = 0;
};

}  // namespace touchtrial::study
