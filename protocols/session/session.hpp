/// \file The state machine of one session: the inputs that each phase accepts, and their events.
/// Simulated and real sessions share it; it is independent of participants and clocks.
#pragma once

#include "record/session_bodies.hpp"
#include "record/session_recorder.hpp"
#include "study/course.hpp"
#include "study/study_key.hpp"

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace touchtrial::record {}

namespace touchtrial::session {

/// The state of a session.
enum class SessionPhase {
  fresh,       ///< nothing recorded yet
  opened,      ///< waits for the device's calibration
  calibrated,  ///< waits for the participant's instruction
  ready,       ///< between trials
  exploring,   ///< the plane is on
  answering,   ///< the plane is off or fading; no picture chosen yet
  chosen,      ///< an answer is chosen but not confirmed
  paused,
  finished,  ///< every presentation is done
  stopped,   ///< ended before all presentations were done
  closed,
};
[[nodiscard]] std::string_view name_of(SessionPhase phase);

/// The inputs of the state machine.
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
  note,  ///< also for other remarks: deviations, ticks, questionnaires, marks
  stop,
  close,
};
[[nodiscard]] std::string_view name_of(SessionInput input);

/// Serialises a restarted block's trials for sealing (OnInterruption::restart_block).
using SerialiseBlock = std::function<std::string(const std::vector<study::Trial>&)>;
/// \param codes  must outlive the session
[[nodiscard]] SerialiseBlock block_serialiser(const study::StudyCodes& codes);

/// The remarks recorded so far, so that no question is asked twice.
struct SessionRemarks {
  std::set<std::string> ticked;                ///< items of the day sheet
  std::set<std::string> deviations;            ///< codes of deviations
  std::set<std::string> questionnaires;        ///< names
  std::vector<record::PracticeBody> practice;  ///< in chronological order
};

/// A session as an event-driven state machine, which owns its position in the schedule and the
/// recorder. Times are arguments: they count from the session's opening and never decrease.
///
/// Every input below throws std::logic_error if the phase does not accept it (see `accepts`) or if
/// its time is before the last event's, and StoreError if the event could not be stored. In both
/// cases nothing has changed. An answer therefore counts, and may be acknowledged on a screen, as
/// soon as `confirm` has returned. Not thread-safe.
class Session {
 public:
  using Time = std::chrono::nanoseconds;

  /// \param seal  needed only if the study restarts blocks
  Session(std::unique_ptr<study::Order> order, const study::TrialOptions& options,
          record::SessionRecorder recorder, SerialiseBlock seal = {});

  /// Restores the state after a session's stored events; the recorder continues after the last one.
  /// Records nothing.
  /// \param events  decrypted (record::opened_event)
  /// \throws StoreError if the events are impossible for such a session
  void restore(std::span<const record::Event> events);
  /// Resumes the session after the program ended: interrupts the current presentation, if there is
  /// one, and ends a pause.
  void resume_after_exit(Time at, const record::ResumedBody& body);

  /// Called for every accepted input, before it is recorded, with the current trial's number (0
  /// after the last).
  using Observer = std::function<void(SessionInput, int trial)>;
  void set_observer(Observer observer) { observer_ = std::move(observer); }

  [[nodiscard]] const study::TrialOptions& options() const noexcept { return options_; }
  [[nodiscard]] SessionPhase phase() const noexcept { return phase_; }
  [[nodiscard]] bool accepts(SessionInput input) const noexcept;
  /// The choice at each position of the answer screen: an index into the choices.
  [[nodiscard]] const std::vector<int>& layout() const noexcept {
    return course_.schedule().layout;
  }
  /// The current trial, or between trials the next one; null when all are done.
  [[nodiscard]] const study::Trial* current() const noexcept { return course_.current(); }
  /// The number of remaining presentations, including the current one.
  [[nodiscard]] int presentations_left() const noexcept { return course_.remaining(); }
  /// The number of presentations begun so far, including interrupted ones.
  [[nodiscard]] int presentations_begun() const noexcept { return begun_; }
  /// Whether a presentation has begun and is not done.
  [[nodiscard]] bool in_presentation() const noexcept;
  [[nodiscard]] const SessionRemarks& remarks() const noexcept { return remarks_; }
  /// Time of the last event.
  [[nodiscard]] Time last() const noexcept { return last_; }
  /// Whether the study requires a break before the next presentation.
  [[nodiscard]] bool is_break_due() const noexcept;

  /// \param secret_schedule  schedule_to_json's text, stored sealed
  void open(Time at, const record::SessionOpening& opening, const std::string& secret_schedule);
  void calibrate(Time at, const std::string& text = "");
  void instruct(Time at, const std::string& text = "");

  /// The plane appears.
  void present(Time at);
  /// The stylus lands on the plane. Records only the first time in a presentation.
  void contact(Time at);
  /// The participant is done exploring.
  void end_exploring(Time at);
  /// Exploration time is up. An answer is still required; or, with no-response in the study, the
  /// presentation is done without one, and its evidence is stored now.
  void time_out(Time at);
  /// A comfort stop or a device fault interrupted the presentation. The study's on_interruption
  /// decides whether it is repeated. Its evidence is discarded.
  /// \param reason  stored unencrypted: a fixed phrase that does not depend on the stimulus. After
  ///   record::kPauseReason, the presentation is repeated next.
  /// \param detail  sealed, except for the names of faults
  void interrupt(Time at, const std::string& reason,
                 const std::optional<record::InterruptionDetail>& detail = std::nullopt);
  /// SessionRecorder::pack_evidence. May be called on another thread, except during `restore`.
  [[nodiscard]] record::TrialEvidence pack_evidence(const record::TraceBody& body,
                                                    const record::TrialMeasures& measures,
                                                    const record::Trace& trace) const {
    return recorder_.pack_evidence(body, measures, trace);
  }
  /// Replaces the evidence of the current presentation. It is stored together with the answer, or
  /// with a time-out without an answer.
  void keep_evidence(record::TrialEvidence evidence);
  /// The participant returns to the plane before answering; not accepted after a time-out.
  void explore_again(Time at);

  /// Chooses an alternative, which can be changed once before `confirm` records it.
  /// \param position  position in the layout
  /// \throws std::invalid_argument if the layout has no such position
  void choose(int position);
  /// Sets the ratings, which replace earlier ones until `confirm` records them.
  /// \throws std::invalid_argument if a value is not finite
  void rate(std::vector<double> values);
  /// Records the answer (with the first choice, if it was changed) and the evidence atomically.
  void confirm(Time at, std::optional<int> confidence = std::nullopt);

  /// Records one presentation of practice, between instruction and the first trial.
  void practise(Time at, const record::PracticeBody& body);
  void take_break(Time at, const std::string& text = "");
  /// Accepted whenever the plane is off; `resume` returns to the previous phase. During an
  /// exploration, first `interrupt` the presentation with record::kPauseReason.
  void pause(Time at, const std::string& reason);
  void resume(Time at);
  // Remarks, which are accepted at any time between opening and closing.
  void note(Time at, const std::string& text);
  void deviate(Time at, const record::DeviationBody& body);
  /// \param item  the item's code
  void tick(Time at, const std::string& item);
  /// \param answers  JSON, sealed
  void question(Time at, const std::string& name, const std::string& answers);
  /// Records the marks sent to other instruments.
  void mark(Time at, const record::MarksBody& marks);
  /// Ends the session early. The current presentation remains without an answer.
  /// \param reason  free text of the experimenter, sealed; may be empty
  /// \param code  the program's reason for stopping the session, unencrypted; otherwise empty
  void stop(Time at, const std::string& reason, const std::string& code = "");
  /// \param states_one_key  whether the closing event states, unencrypted, if 95 % of 20 or more
  ///   answers are at one position. True only if the positions of the choices are randomised
  ///   (study::TrialQuestion::has_pictures); otherwise a position would reveal the outcome.
  void close(Time at, bool states_one_key = false);

 private:
  /// Checks that the phase accepts the input at this time, and notifies the observer.
  void require(SessionInput input, Time at) const;
  [[nodiscard]] bool is_open() const noexcept;
  [[nodiscard]] bool has_changed_choice() const noexcept;
  void move_to(SessionPhase phase, Time at) noexcept;
  void begin_presentation(Time at) noexcept;
  void finish_presentation(Time at, const std::optional<Answer>& answer);
  void count(const Answer& answer);
  [[nodiscard]] std::optional<int> current_trial_number() const noexcept;
  void note_force(double largest_n);
  /// Voids the current presentation by the study's on_interruption; after kPauseReason, the
  /// presentation is repeated next.
  void void_presentation(Time at, const std::string& reason);
  /// Redraws, records and restarts a block, if the course requires it.
  void restart_block(Time at);
  /// The phase between trials, or after the last.
  [[nodiscard]] SessionPhase between_trials() const noexcept;

  // These functions apply stored events (session_restore.cpp). Two of them return whether they
  // handled the event.
  void apply(const record::Event& event);
  [[nodiscard]] bool apply_to_trial(const record::Event& event);
  [[nodiscard]] bool apply_to_remarks(const record::Event& event);
  void apply_to_course(const record::Event& event);

  study::Course course_;
  study::TrialOptions options_;
  record::SessionRecorder recorder_;
  SerialiseBlock serialise_block_;
  Observer observer_;
  SessionPhase phase_ = SessionPhase::fresh;
  SessionPhase before_pause_ = SessionPhase::ready;
  Time last_{};
  bool had_contact_ = false;
  bool was_timed_out_ = false;
  std::optional<record::TrialEvidence> evidence_;
  std::optional<Answer> answer_;
  SessionRemarks remarks_;
  int answered_ = 0;
  std::map<int, int> choices_;             ///< number of choices by position
  std::optional<double> largest_force_n_;  ///< maximum over all presentations
  int begun_ = 0;
  int done_since_break_ = 0;
  Time work_began_at_{};  ///< start of the first trial after the last break
};

}  // namespace touchtrial::session
