#include "protocols/session/session_runner.hpp"

#include "protocols/session/interruption_words.hpp"
#include "protocols/session/trial_measures.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace touchtrial {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

// In virtual time; people take the time that they take.
constexpr seconds kCalibration{30};
constexpr seconds kInstruction{120};
constexpr seconds kBreak{60};
constexpr seconds kBetweenTrials{2};

constexpr milliseconds kFade{100};

ServoOptions servo_options(const Study& study, double rate_hz) {
  ServoOptions options;
  options.rate_hz = rate_hz;
  options.limit_ticks = std::llround(study.trials.explore_limit_s * rate_hz);
  options.fade_ticks = std::llround(std::chrono::duration<double>(kFade).count() * rate_hz);
  options.limits.max_force_n = study.rendering.max_force_n;
  return options;
}

class SessionRun {
 public:
  SessionRun(Session& session, const SessionParts& parts)
      : session_(session), parts_(parts), servo_(servo_options(parts.key.study, parts.rate_hz)) {}

  SessionTally run() {
    prepare();
    const int most_interruptions = session_.presentations_left();
    while (session_.phase() == SessionPhase::ready && await_device()) {
      parts_.clock.pass(kBetweenTrials);
      if (session_.break_due()) take_break();
      run_trial();
      if (interruptions_ > most_interruptions) session_.stop(now(), "too many faults");
    }
    session_.close(now());
    tally_.duration = now();
    return tally_;
  }

 private:
  [[nodiscard]] SessionClock::Time now() { return parts_.clock.now(); }

  void prepare() {
    SupplyState device = parts_.devices.make_ready();
    while (device == SupplyState::not_yet) device = parts_.devices.make_ready();
    if (device == SupplyState::stopped) return give_up();
    parts_.clock.pass(kCalibration);
    session_.calibrate(now());
    parts_.clock.pass(kInstruction);
    session_.instruct(now());
    std::vector<std::string> pictures;
    for (const int class_index : session_.layout()) {
      pictures.push_back(parts_.key.study.classes[class_index].label);
    }
    parts_.participant.see_pictures(pictures);
  }

  void give_up() { session_.stop(now(), "stopped while waiting for the device"); }

  /// \return whether the device is ready, after a pause if it was not
  bool await_device() {
    SupplyState device = parts_.devices.make_ready();
    if (device == SupplyState::ready) return true;
    session_.pause(now(), "waiting for the device");
    while (device == SupplyState::not_yet) device = parts_.devices.make_ready();
    if (device == SupplyState::stopped) {
      give_up();
      return false;
    }
    session_.resume(now());
    return true;
  }

  void take_break() {
    session_.take_break(now());
    parts_.clock.pass(kBreak);
    static_cast<void>(parts_.participant.attend(BreakStep{}));
  }

  void run_trial() {
    const StimulusIndex& stimulus = session_.current()->stimulus;
    const RenderingModel& model = parts_.source.model(parts_.key.code_of(stimulus));
    if (parts_.explorer.in_real_time()) parts_.source.fetch();
    const SessionClock::Time plane_on = now();
    session_.present(plane_on);
    const Exploration done =
        parts_.explorer.explore(model, parts_.source.plane(), parts_.participant, servo_, trace_);
    parts_.clock.pass(done.lasted);
    ++tally_.presentations;
    tally_.ticks += done.servo.ticks;
    // Ticks are counted from the servo's start, a moment after plane-on. What is stamped after the
    // exploration has the time of its end and not of now: how long a trace takes to pack, or a
    // flight record to write, tells rough textures from smooth ones.
    const SessionClock::Time ended = std::min(plane_on + done.lasted, now());
    if (done.landed_at) session_.contact(std::min(plane_on + *done.landed_at, ended));
    if (is_interrupted(done.servo)) return interrupt(done, ended);
    store_trace(done, ended);
    if (done.servo.end == ServoEnd::time_limit) {
      session_.time_out(ended);
    } else {
      session_.end_exploring(ended);
    }
    if (session_.phase() == SessionPhase::answering) take_answer();
  }

  void interrupt(const Exploration& done, SessionClock::Time ended) {
    ++interruptions_;
    session_.interrupt(ended, words_in_clear(done.servo), done.detail);
    parts_.devices.interrupted();
  }

  void store_trace(const Exploration& done, SessionClock::Time ended) {
    TrialFindings findings = findings_of(trace_, done.servo.force_limit_n);
    if (done.held_in_contact > 0) findings.measures.within_limits = false;
    if (!findings.valid()) ++tally_.invalid_trials;
    TraceBody body;
    body.trial = session_.current()->trial;
    body.rate_hz = trace_.rate_hz;
    body.overruns = done.servo.overruns;
    body.valid = findings.long_enough;
    body.servo = done.health;
    if (done.health) findings.measures.limited_ticks = done.servo.limited_ticks;
    session_.store_trace(ended, body, findings.measures, trace_);
  }

  void take_answer() {
    std::optional<StepReply> answer = parts_.participant.attend(AnswerStep{});
    while (!answer) answer = parts_.participant.attend(AnswerStep{});
    session_.choose(answer->position);
    parts_.clock.pass(answer->took);
    session_.confirm(now());
  }

  Session& session_;
  const SessionParts& parts_;
  ServoOptions servo_;
  Trace trace_;
  SessionTally tally_;
  int interruptions_ = 0;
};

}  // namespace

SessionTally run_session(Session& session, const SessionParts& parts) {
  return SessionRun(session, parts).run();
}

SessionTally run_session_in_virtual_time(Session& session, const StudyKey& key,
                                         const StimulusSource& source, Participant& participant) {
  VirtualSessionClock clock;
  VirtualExplorer explorer;
  AlwaysReady devices;
  return run_session(session, {key, source, participant, clock, explorer, devices});
}

}  // namespace touchtrial
