/// \file The order of one participant's trials.
#pragma once

#include "study/schedule.hpp"

#include <optional>
#include <vector>

namespace touchtrial::study {

/// What a session presents to one participant, trial by trial. This class presents what its
/// schedule lists. A derived class may be adaptive: its schedule then has trials without planes,
/// and `at` fills them in. The choices depend only on the participant's draw and on past
/// notifications, so that a resumed session, and the check of its record, choose the same. Not
/// thread-safe.
class Order {
 public:
  /// \param schedule  trials are numbered from 1, blocks from 0
  /// \param secret  of the participant's draw, from which restarted blocks are drawn
  Order(Schedule schedule, const SecretKey& secret);
  virtual ~Order() = default;
  Order(const Order&) = delete;
  Order& operator=(const Order&) = delete;

  /// The schedule, which is sealed when the session opens.
  [[nodiscard]] const Schedule& schedule() const noexcept { return schedule_; }
  /// Whether answers decide what is presented. Blocks of such an order cannot be restarted.
  [[nodiscard]] bool is_adaptive() const noexcept;

  /// The trial to present at a place of the schedule. It has the same place, and changes only after
  /// a notification.
  [[nodiscard]] virtual Trial at(const Trial& scheduled) const { return scheduled; }
  /// Notifies the order of the answer to the last presented trial.
  /// \param shown  as `at` returned it
  virtual void answered(const Trial& /*shown*/, const Answer& /*answer*/) {}
  /// Notifies the order that the last presented trial was interrupted, except by a pause. It may be
  /// repeated.
  virtual void interrupted(const Trial& /*shown*/) {}

  /// Draws a block again in a fresh order with the same number of catch trials; the default
  /// shuffles its trials. The result depends only on the arguments and the draw, and reveals
  /// nothing about the old order.
  /// \param block  from 0
  /// \param restarts_before  earlier restarts of this block, from 0
  /// \param first_trial  number of the first trial; the others count up from it
  /// \throws StudyError if the study does not permit the order
  /// \throws std::invalid_argument if the schedule has no such block
  [[nodiscard]] virtual std::vector<Trial> redraw_block(int block, int restarts_before,
                                                        int first_trial) const;

 private:
  Schedule schedule_;
  SecretKey secret_;
};

}  // namespace touchtrial::study
