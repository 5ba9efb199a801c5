/// \file The course of one session: what may happen next, and what is recorded of it.
/// Used by simulated and by real sessions alike; independent of who answers and of any clock.
#pragma once

#include "protocols/design/schedule.hpp"
#include "protocols/store/session_recorder.hpp"

#include <chrono>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::session {

/// Where a session stands.
enum class SessionPhase {
  fresh,       ///< nothing recorded yet
  opened,      ///< the device is to be calibrated
  calibrated,  ///< the participant is to be instructed
  ready,       ///< between trials
  exploring,   ///< the plane is on
  answering,   ///< the plane is off or fading; no picture chosen yet
  chosen,      ///< a picture is chosen, waiting for Next
  paused,
  finished,  ///< every presentation is done
  stopped,   ///< ended before that
  closed,
};
[[nodiscard]] std::string_view name_of(SessionPhase phase);

/// What can happen to a session.
enum class SessionInput {
  open,
  calibrate,
  instruct,
  present,
  contact,
  end_exploring,
  time_out,
  interrupt,
  keep_evidence,
  explore_again,
  choose,
  confirm,
  practise,
  take_break,
  pause,
  resume,
  note,  ///< and what else may be said at any time: deviations, ticks, questionnaires
  stop,
  close,
};
[[nodiscard]] std::string_view name_of(SessionInput input);

/// How a block comes again in a fresh order (OnInterruption::restart_block).
struct BlockRestart {
  /// The block's new presentations; the same for the same arguments.
  std::function<std::vector<design::Presentation>(int block, int restarts_before, int first_trial)>
      draw;
  /// What is sealed of them.
  std::function<std::string(const std::vector<design::Presentation>&)> secret;
};

/// What was said so far beside the trials, so that nobody is asked twice.
struct SessionRemarks {
  std::set<std::string> ticked;               ///< items of the day sheet
  std::set<std::string> deviations;           ///< codes
  std::set<std::string> questionnaires;       ///< names
  std::vector<store::PracticeBody> practice;  ///< in their order
};

/// A session as an event-driven state machine that owns the place in the schedule and the recorder.
/// Times come in as arguments: since the session's opening, never decreasing.
///
/// Every input below throws std::logic_error if it does not fit the phase (`accepts` tells before)
/// or its time lies before the last one's, and StoreError if the event could not be stored. Either
/// way nothing has changed then, so that an answer counts, and may be acknowledged on a screen,
/// exactly when `confirm` has returned. Not thread-safe.
class Session {
 public:
  using Time = std::chrono::nanoseconds;

  /// \param restart  needed only if the study restarts blocks
  Session(design::Schedule schedule, const design::TrialOptions& options,
          store::SessionRecorder recorder, BlockRestart restart = {});

  /// Goes through what is stored of this session, and stands where it stood; the recorder goes on
  /// after the last event. On a fresh session only; records nothing.
  /// \throws StoreError if the events are not those of such a session
  void restore(std::span<const store::Event> events);
  /// The program has ended in the midst of the session, and this one takes it up: a presentation
  /// that was under way is interrupted, a pause is over.
  void take_up(Time at, const store::ResumedBody& body);

  [[nodiscard]] SessionPhase phase() const noexcept { return phase_; }
  [[nodiscard]] bool accepts(SessionInput input) const noexcept;
  /// Class index of the picture at each position.
  [[nodiscard]] const std::vector<int>& layout() const noexcept { return schedule_.layout; }
  /// What `present` shows next, or, from `present` to the trial's end, what is shown now; nothing
  /// when all is done.
  [[nodiscard]] const design::Presentation* current() const noexcept;
  /// Presentations still to be done, the current one included.
  [[nodiscard]] int presentations_left() const noexcept { return static_cast<int>(queue_.size()); }
  /// Presentations begun so far, interrupted ones included.
  [[nodiscard]] int presentations_begun() const noexcept { return begun_; }
  /// Whether a presentation was begun that is not done yet.
  [[nodiscard]] bool in_presentation() const noexcept;
  [[nodiscard]] const SessionRemarks& remarks() const noexcept { return remarks_; }
  /// Of the last event.
  [[nodiscard]] Time last() const noexcept { return last_; }
  /// Whether the study wants a break before the next presentation.
  [[nodiscard]] bool break_due() const noexcept;

  /// \param secret_schedule  schedule_to_json's text, stored sealed
  void open(Time at, const store::SessionOpening& opening, const std::string& secret_schedule);
  void calibrate(Time at, const std::string& text = "");
  void instruct(Time at, const std::string& text = "");

  /// The plane goes on.
  void present(Time at);
  /// The stylus reaches the plane; only the first time in a presentation is recorded.
  void contact(Time at);
  /// The participant is done exploring.
  void end_exploring(Time at);
  /// Exploration time is up: an answer is still required, or, if the study says no-response, the
  /// presentation is done without one; its evidence is stored then.
  void time_out(Time at);
  /// The presentation was spoilt (a comfort stop, a device fault): what becomes of it, the study's
  /// on_interruption says. Nothing is kept of its evidence.
  /// \param reason  in clear: must tell nothing of the stimulus  \param detail  sealed
  void interrupt(Time at, const std::string& reason,
                 const std::optional<store::InterruptionDetail>& detail = std::nullopt);
  /// SessionRecorder::packed; may be called on another thread, but not beside `restore`.
  [[nodiscard]] store::TrialEvidence packed(const store::TraceBody& body,
                                            const store::TrialMeasures& measures,
                                            const store::Trace& trace) const {
    return recorder_.packed(body, measures, trace);
  }
  /// The samples of the presentation so far; those kept before are forgotten. Stored together with
  /// the answer, or with a time-out without one.
  void keep_evidence(store::TrialEvidence evidence);
  /// The participant goes back to the plane before answering; not once time was up.
  void explore_again(Time at);

  /// A picture is chosen, by its position in the layout; it can be changed once before `confirm`.
  /// Recorded by `confirm`. \throws std::invalid_argument if there is no such position
  void choose(int position);
  /// Next: records the answer, the one before a change, and the evidence, all or nothing.
  void confirm(Time at, std::optional<int> confidence = std::nullopt);

  /// One presentation of the practice, between instruction and the first trial.
  void practise(Time at, const store::PracticeBody& body);
  void take_break(Time at, const std::string& text = "");
  /// Whenever nothing is on the plane; `resume` goes on where `pause` was.
  void pause(Time at, const std::string& reason);
  void resume(Time at);
  /// Remarks, at any time between opening and closing.
  void note(Time at, const std::string& text);
  void deviate(Time at, const store::DeviationBody& body);
  /// \param item  its code
  void tick(Time at, const std::string& item);
  /// \param answers  JSON, sealed
  void question(Time at, const std::string& name, const std::string& answers);
  /// Ends the session early. A presentation that is under way remains without an answer.
  void stop(Time at, const std::string& reason);
  void close(Time at);

 private:
  struct Answer {
    int position = 0;
    std::optional<int> first_position;
  };

  void require(SessionInput input, Time at) const;
  [[nodiscard]] bool is_under_way() const noexcept;
  void move_to(SessionPhase phase, Time at) noexcept;
  void begin_presentation(Time at) noexcept;
  void finish_presentation(Time at) noexcept;
  /// Takes the current presentation off, as the study's on_interruption has it.
  void give_up_presentation(Time at);
  void restart_block(Time at);
  [[nodiscard]] std::vector<design::Presentation> drawn_again(int block, int first_trial);
  void replace_block(int block, std::vector<design::Presentation> presentations);

  // What stored events do, by group (session_restore.cpp).
  void follow(const store::Event& event);
  [[nodiscard]] bool follow_trial(const store::Event& event);
  [[nodiscard]] bool follow_remark(const store::Event& event);
  void follow_course(const store::Event& event);

  design::Schedule schedule_;
  design::TrialOptions options_;
  store::SessionRecorder recorder_;
  BlockRestart restart_;
  std::deque<std::size_t> queue_;  ///< indices into the schedule, the current one first
  SessionPhase phase_ = SessionPhase::fresh;
  SessionPhase before_pause_ = SessionPhase::ready;
  Time last_{};
  bool had_contact_ = false;
  bool was_timed_out_ = false;
  std::optional<store::TrialEvidence> evidence_;
  std::optional<Answer> answer_;
  std::optional<int> block_to_restart_;
  std::map<int, int> restarts_;  ///< of each block
  SessionRemarks remarks_;
  int begun_ = 0;
  int done_since_break_ = 0;
};

}  // namespace touchtrial::session
