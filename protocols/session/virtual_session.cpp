#include "protocols/session/virtual_session.hpp"

#include "protocols/session/exploration.hpp"
#include "protocols/session/trial_measures.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace touchtrial {
namespace {

using std::chrono::seconds;

constexpr seconds kCalibration{30};
constexpr seconds kInstruction{120};
constexpr seconds kBreak{60};
constexpr seconds kBetweenTrials{2};
constexpr std::int64_t kFadeTicks = 100;

class VirtualSession {
 public:
  VirtualSession(Session& session, const StudyKey& key, const StimulusSource& source,
                 Participant& participant)
      : session_(session), key_(key), source_(source), participant_(participant) {
    const TrialOptions& trials = key.study.trials;
    servo_.limit_ticks = std::llround(trials.explore_limit_s * kServoRateHz);
    servo_.fade_ticks = kFadeTicks;
    servo_.limits.max_force_n = key.study.rendering.max_force_n;
  }

  SessionTally run() {
    prepare();
    const int most_faults = session_.presentations_left();
    while (session_.phase() == SessionPhase::ready) {
      now_ += kBetweenTrials;
      if (session_.break_due()) take_break();
      run_trial();
      if (faults_ > most_faults) session_.stop(now_, "too many faults");
    }
    session_.close(now_);
    tally_.duration = now_;
    return tally_;
  }

 private:
  void prepare() {
    session_.calibrate(now_ += kCalibration);
    session_.instruct(now_ += kInstruction);
    std::vector<std::string> pictures;
    for (const int class_index : session_.layout()) {
      pictures.push_back(key_.study.classes[class_index].label);
    }
    participant_.see_pictures(pictures);
  }

  void take_break() {
    session_.take_break(now_);
    now_ += kBreak;
  }

  void run_trial() {
    const RenderingModel& model = source_.model(key_.code_of(session_.current()->stimulus));
    session_.present(now_);
    const Exploration done = explore(model, source_.plane(), participant_, servo_, trace_);
    ++tally_.presentations;
    tally_.ticks += done.servo.ticks;
    if (done.landed_at) session_.contact(now_ + *done.landed_at);
    now_ += done.servo.ticks * kServoTick;
    if (done.servo.end == ServoEnd::fault) {
      ++faults_;
      session_.interrupt(now_, "device fault");
      return;
    }
    store_trace(done.servo.force_limit_n);
    if (done.servo.end == ServoEnd::time_limit) {
      session_.time_out(now_);
    } else {
      session_.end_exploring(now_);
    }
    if (session_.phase() == SessionPhase::answering) take_answer();
  }

  void store_trace(double force_limit_n) {
    const TrialFindings findings = findings_of(trace_, force_limit_n);
    if (!findings.valid()) ++tally_.invalid_trials;
    TraceBody body;
    body.trial = session_.current()->trial;
    body.rate_hz = kServoRateHz;
    body.valid = findings.long_enough;
    session_.store_trace(now_, body, findings.measures, trace_);
  }

  void take_answer() {
    const ParticipantAnswer answer = participant_.answer();
    session_.choose(answer.position);
    session_.confirm(now_ += answer.thought);
  }

  Session& session_;
  const StudyKey& key_;
  const StimulusSource& source_;
  Participant& participant_;
  ServoOptions servo_;
  Trace trace_;
  SessionTally tally_;
  std::chrono::nanoseconds now_{};
  int faults_ = 0;
};

}  // namespace

SessionTally run_session_in_virtual_time(Session& session, const StudyKey& key,
                                         const StimulusSource& source, Participant& participant) {
  return VirtualSession(session, key, source, participant).run();
}

}  // namespace touchtrial
