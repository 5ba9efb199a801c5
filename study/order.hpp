/// \file The order of one participant's trials.
#pragma once

#include "study/schedule.hpp"

#include <optional>
#include <vector>

namespace touchtrial::study {

/// What a session presents to one participant, in their order. This class presents what its
/// schedule lists. In a derived class answers may decide: its schedule then has trials without
/// planes, and `at` fills them. What an order chooses is a function of the participant's draw and
/// of what it was notified of, and so a session that is taken up again, and the check of its
/// record, choose the same. Not thread-safe.
class Order {
 public:
  /// \param schedule  trials are numbered from 1, blocks from 0
  /// \param secret  of the participant's draw; blocks are restarted with it
  Order(Schedule schedule, const SecretKey& secret);
  virtual ~Order() = default;
  Order(const Order&) = delete;
  Order& operator=(const Order&) = delete;

  /// Sealed when the session opens.
  [[nodiscard]] const Schedule& schedule() const noexcept { return schedule_; }
  /// Whether answers decide what is presented. Blocks of such an order cannot be restarted.
  [[nodiscard]] bool is_adaptive() const noexcept;

  /// The trial that is presented at a place of the schedule: the same until something is notified.
  /// Its place stays.
  [[nodiscard]] virtual Trial at(const Trial& scheduled) const { return scheduled; }
  /// Notifies of the answer to what was presented last.
  /// \param shown  as `at` returned it
  virtual void answered(const Trial& /*shown*/, const Answer& /*answer*/) {}
  /// Notifies that what was presented last was interrupted, but for a pause; it may be repeated.
  virtual void interrupted(const Trial& /*shown*/) {}

  /// Draws a block again in a fresh order, with as many catch trials as before; by default shuffles
  /// its trials. Depends only on the arguments and the draw, and reveals nothing about the old
  /// order.
  /// \param block  from 0
  /// \param restarts_before  earlier restarts of this block, from 0
  /// \param first_trial  number of the first trial; the others count up from it
  /// \throws StudyError if the order is impossible for the study
  /// \throws std::invalid_argument if the schedule has no such block
  [[nodiscard]] virtual std::vector<Trial> restarted(int block, int restarts_before,
                                                     int first_trial) const;

 private:
  Schedule schedule_;
  SecretKey secret_;
};

}  // namespace touchtrial::study
