#include "analysis/planning/pool_sessions.hpp"

#include "protocols/session/session_runner.hpp"
#include "protocols/simulation/trial_course.hpp"
#include "record/session_recorder.hpp"
#include "study/protocol.hpp"

#include <memory>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace touchtrial::planning {
namespace {

/// An order that reports its answers to an observer.
class ObservedOrder final : public study::Order {
 public:
  ObservedOrder(std::unique_ptr<study::Order> order, const AnswerObserver& on_answer)
      : Order(order->schedule(), SecretKey{}), order_(std::move(order)), on_answer_(on_answer) {}

  study::Trial at(const study::Trial& scheduled) const override { return order_->at(scheduled); }
  void answered(const study::Trial& shown, const Answer& answer) override {
    order_->answered(shown, answer);
    on_answer_(*order_, shown, answer);
  }
  void interrupted(const study::Trial& shown) override { order_->interrupted(shown); }
  std::vector<study::Trial> redraw_block(int block, int restarts_before,
                                         int first_trial) const override {
    return order_->redraw_block(block, restarts_before, first_trial);
  }

 private:
  std::unique_ptr<study::Order> order_;
  const AnswerObserver& on_answer_;
};

/// \return whether the session reached its end
bool run_pool_session(const PoolSetting& setting, int number, int visit,
                      simulation::SimulatedParticipant& participant,
                      const AnswerObserver& on_answer) {
  const study::StudyKey& key = setting.key;
  const study::ScheduleDraw draw = key.draw_of(number, study::Draws::rehearsal, visit);
  auto order = std::make_unique<ObservedOrder>(study::make_order(key.study, draw), on_answer);
  const study::Schedule schedule = order->schedule();
  record::BufferedEvents discarded_events;
  session::Session session(std::move(order), key.study.trials,
                           record::SessionRecorder(number, SecretKey{}, discarded_events),
                           session::block_serialiser(key));
  record::SessionOpening opening;
  opening.participant = fmt::format("P{:03}", number);
  opening.enrolment = number;
  opening.visit = visit;
  opening.study_id = key.study_id;
  opening.seal = key.seal;
  opening.device = simulation::recorded_device(setting.subject);
  opening.simulated = true;
  session.open({}, opening, study::schedule_to_json(schedule, key));
  participant.start_visit(visit, simulation::course_of(key.study, schedule));
  static_cast<void>(
      session::run_session_in_virtual_time(session, key, setting.source, participant));
  return session.presentations_left() == 0;
}

}  // namespace

bool run_pool_sessions(const PoolSetting& setting, int number, const AnswerObserver& on_answer) {
  const auto participant = setting.population.participant(number);
  for (int visit = 1; visit <= setting.key.study.visits.count; ++visit) {
    if (!run_pool_session(setting, number, visit, *participant, on_answer)) return false;
  }
  return true;
}

}  // namespace touchtrial::planning
