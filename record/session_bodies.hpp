/// \file The bodies of a session's events, and the texts sealed with them. Each struct is one JSON
/// object; `describe` lists its members.
#pragma once

#include "core/answer.hpp"
#include "core/errors.hpp"
#include "core/hash.hpp"
#include "record/body_io.hpp"
#include "record/trace_bodies.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace touchtrial::record {

/// The participant's screen.
struct ScreenRecord {
  double mm_per_px = 0.0;
  std::string source;

  void describe(BodyIo& io) {
    io("mm_per_px", mm_per_px, "of the participant's screen, in the pixels of windows");
    io("source", source,
       "`measured` (by `screen calibrate`), `stated` (by the monitor) or `assumed`");
  }
  friend bool operator==(const ScreenRecord&, const ScreenRecord&) = default;
};

/// The device of a session.
struct StationRecord {
  std::string model;
  std::string firmware;
  double max_force_n = 0.0;
  bool visual = false;
  double rate_hz = 0.0;
  std::string scheduling;
  std::string calibration{};  ///< hash of the certificate, or study::kUnverifiedDevice
  std::optional<ScreenRecord> screen{};
  std::array<double, 3> force_scale{1.0, 1.0, 1.0};
  std::array<double, 3> length_scale{1.0, 1.0, 1.0};

  void describe(BodyIo& io) {
    io("model", model, "reported by the device; may be empty");
    io("firmware", firmware, "reported by the device; may be empty");
    io("max_force_n", max_force_n, "of the device");
    io("visual", visual, "textures are shown on a screen instead of felt: pilot sessions only");
    io("rate_hz", rate_hz, "requested of the servo");
    io("scheduling", scheduling,
       "scheduling that the servo's thread obtained, for instance `fifo 80, memory locked`");
    io("calibration", calibration,
       "SHA-256 of the device's certificate, hexadecimal; `UNVERIFIED DEVICE`: the session was "
       "allowed without a valid one; empty: none, as for devices without force");
    io.part("screen", screen, "if the participant sees a window");
    io("force_scale", force_scale, "of the device settings, by axis of the device frame");
    io("length_scale", length_scale, "of the device settings, by axis of the device frame");
  }
  friend bool operator==(const StationRecord&, const StationRecord&) = default;
};

/// `opened`.
struct SessionOpening {
  std::string participant{};
  int enrolment = 0;
  int visit = 1;
  std::string group{};
  std::string study_id{};
  Digest seal{};
  std::string device{};
  std::string device_serial{};
  std::string opened_utc{};
  bool simulated = false;
  bool pilot = false;
  std::optional<StationRecord> station{};

  void describe(BodyIo& io) {
    io("participant", participant, "1 to 32 of `[0-9A-Za-z+-_]`; unique in a study");
    io("enrolment", enrolment, "decides the schedule; unique in a study", {.min = 1});
    io.omit_if(1, "visit", visit, "of the participant; absent: the first", {.min = 2});
    io.omit_if_empty("group", group, "the participant's group, if the study's groups are open");
    io("study_id", study_id, "as in `study-committed`");
    io("seal", seal, "as in `study-committed`");
    io("device", device, "name of the driver");
    io("device_serial", device_serial, "of the device; empty if it has none");
    io("opened_utc", opened_utc, "ISO 8601; empty if simulated");
    io("simulated", simulated, "whether the participant is simulated");
    io("pilot", pilot, "whether the study is a pilot");
    io.part("station", station, "only of sessions in real time");
  }
  [[nodiscard]] bool is_visual() const noexcept { return station && station->visual; }
};

/// `calibrated`, `instructed`, `break-taken`, `ticked` and `questioned`.
struct TextBody {
  std::string text;

  void describe(BodyIo& io) { io("text", text, "one line, or empty"); }
};

/// `noted`.
struct RemarkBody {
  std::string text;

  void describe(BodyIo& io) { io("text", text, "the experimenter's words", {.sealed = true}); }
};

/// The members of a body that describe the answer to a trial.
inline void describe_answer(BodyIo& io, std::optional<Answer>& answer) {
  std::optional<int> position = position_of(answer);
  std::optional<int> first_position = first_position_of(answer);
  std::optional<std::vector<double>> ratings;
  if (answer && !position) ratings = ratings_of(answer);
  io("position", position, "index into the participant's layout of choices", {.sealed = true});
  io("first_position", first_position, "the choice before a change", {.sealed = true});
  io("ratings", ratings, "instead of a position, one number for each scale", {.sealed = true});
  if (!io.reads()) return;
  if (position && ratings) throw StoreError("/ratings and a position exclude each other");
  if (position) answer = ChoiceAnswer{*position, first_position};
  if (ratings) answer = RatingAnswer{std::move(*ratings)};
}

/// `practised`: one presentation of a texture that is not in the study.
struct PracticeBody {
  int round = 0;
  int presentation = 0;
  std::optional<Answer> answer{};  ///< in the layout of the practice
  std::optional<bool> correct{};

  void describe(BodyIo& io) {
    io("round", round, "round of practice", {.min = 1});
    io("presentation", presentation, "in the round", {.min = 1});
    describe_answer(io, answer);
    io("correct", correct, "whether the answer is right; absent if no answer is", {.sealed = true});
  }
};

/// `first-contact`, `timed-out` and `explored-again`. Other bodies about a trial can be read as
/// one.
struct TrialBody {
  int trial = 0;

  void describe(BodyIo& io) { io("trial", trial, "number of the trial", {.min = 1}); }
};

/// `presented`.
struct PresentedBody {
  int trial = 0;
  int block = 0;

  void describe(BodyIo& io) {
    io("trial", trial, "number of the trial", {.min = 1});
    io("block", block, "the trial's block");
  }
};

/// `answered`.
struct AnswerBody {
  int trial = 0;
  std::optional<Answer> answer{};
  std::optional<int> confidence{};
  /// \name The trial, if an adaptive order chose it (study::Trial)
  ///@{
  std::optional<std::string> kind{};
  std::optional<int> track{};
  std::optional<int> level{};
  std::optional<int> target{};
  ///@}

  void describe(BodyIo& io) {
    io("trial", trial, "number of the trial", {.min = 1});
    describe_answer(io, answer);
    io("confidence", confidence, "if the study asks for it", {.sealed = true});
    io("kind", kind,
       "in an adaptive order: the trial's kind, as in the schedule; `catch`: the procedure ignores "
       "the answer",
       {.sealed = true});
    io("track", track,
       "in an adaptive order: the track, from 1; 0: none, with the hand off the device",
       {.sealed = true});
    io("level", level, "in an adaptive order: index into the track's levels", {.sealed = true});
    io("target", target, "in an adaptive order: index of the right choice", {.sealed = true});
  }
};

/// The reason in an `interrupted` for a pause. The presentation is then repeated next, whatever the
/// study does after other interruptions.
inline constexpr const char* kPauseReason = "pause";

/// `interrupted`.
struct InterruptedBody {
  int trial = 0;
  std::string reason;
  std::optional<std::string> safety_fault{};
  std::optional<std::string> device_fault{};
  std::optional<double> largest_force_n{};

  void describe(BodyIo& io) {
    io("trial", trial, "number of the trial", {.min = 1});
    io("reason", reason,
       "`comfort stop`, `emergency stop`, `device lost`, `device fault`, `pause`, `aborted` or "
       "`program ended`");
    io("safety_fault", safety_fault,
       "in real time: `not_finite`, `emergency_stop`, `not_ready` (lost its homing), `overspeed`, "
       "`stale_sample` (no new readings), `frozen_encoders` (new readings of one position, under "
       "force), `stalled` (the servo stood still), or `device`: see `device_fault` "
       "([safety.md](safety.md))");
    io("device_fault", device_fault,
       "in real time: `none`, `link_lost`, `bad_data`, `warm_motors`, `limit_passed`, `driver`");
    io("largest_force_n", largest_force_n, "in real time: in the flight record", {.sealed = true});
  }
};

/// The secret of an `interrupted` in real time: the faults, and the last seconds before them.
struct InterruptionDetail {
  std::string safety_fault;  ///< name of the device layer's SafetyFault
  std::string device_fault;  ///< name of its DeviceFault
  std::int64_t ticks = 0;
  std::string flight;
  double largest_force_n = 0.0;  ///< of these ticks; written into the body

  void describe(BodyIo& io) {
    io("safety_fault", safety_fault, "as in the body");
    io("device_fault", device_fault, "as in the body");
    io("ticks", ticks, "rows of `flight`");
    io("flight", flight,
       "the last seconds before the interruption: CSV with a header row; time, "
       "position, velocity, force requested and sent (both with the device's support), verdict, "
       "faults, lateness, sequence, buttons, ready, and the force that the device reports "
       "(empty if it reports none)");
  }
  friend bool operator==(const InterruptionDetail&, const InterruptionDetail&) = default;
};

/// `paused`.
struct PauseBody {
  std::string text{};
  std::optional<int> trial{};

  void describe(BodyIo& io) {
    io("text", text, "the experimenter's reason; may be empty", {.sealed = true});
    io("trial", trial, "trial with a pending answer; absent: none", {.min = 1});
  }
};

/// `resumed`.
struct ResumedBody {
  std::string after;
  double away_s = 0.0;
  std::string program_version{};
  std::optional<int> trial{};

  void describe(BodyIo& io) {
    io("after", after, "`pause` or `program-ended`");
    io("away_s", away_s, "seconds since the previous event", {.sealed = true});
    io("program_version", program_version, "program version, if the program ended");
    io("trial", trial, "as in the preceding pause", {.min = 1});
  }
};

/// `stopped`.
struct StopBody {
  std::string code{};
  std::string text{};

  void describe(BodyIo& io) {
    io.omit_if_empty(
        "code", code,
        "if the program stopped the session: `too many faults`, `stopped while waiting "
        "for the device`, `restarted`");
    io("text", text, "the experimenter's words; may be empty", {.sealed = true});
  }
};

/// `deviated`.
struct DeviationBody {
  std::string code;
  std::string text;

  void describe(BodyIo& io) {
    io("code", code, "as in the table of deviations");
    io("text", text, "the experimenter's words; may be empty", {.sealed = true});
  }
};

/// `block-restarted`.
struct BlockBody {
  int block = 0;
  int first_trial = 0;

  void describe(BodyIo& io) {
    io("block", block, "number of the block");
    io("first_trial", first_trial, "new number of its first trial", {.min = 1});
  }
};

/// A body without members.
struct EmptyBody {
  void describe(BodyIo& /*io*/) {}
};

/// The secret of a `marked`: the marks sent to other instruments since the last such event, one
/// entry in each list, and the offset of their clock.
struct MarksBody {
  std::vector<std::int64_t> codes{};  ///< values of Mark
  std::vector<std::int64_t> trials{};
  std::vector<std::int64_t> at_ns{};
  std::vector<std::int64_t> latency_ns{};
  std::optional<double> lsl_zero_s{};
  std::optional<double> lsl_uncertainty_s{};

  void describe(BodyIo& io) {
    io("codes", codes, "as on the serial line");
    io("trials", trials, "0 outside trials");
    io("at_ns", at_ns, "time of the mark, since the session's opening");
    io("latency_ns", latency_ns,
       "to the end of the write on the serial line; 0: no line, or the write failed");
    io("lsl_zero_s", lsl_zero_s, "the Lab Streaming Layer's time at the session's opening");
    io("lsl_uncertainty_s", lsl_uncertainty_s, "uncertainty of `lsl_zero_s`");
    const std::size_t count = codes.size();
    if (trials.size() != count || at_ns.size() != count || latency_ns.size() != count) {
      throw StoreError("/codes and the lists beside it differ in length");
    }
  }
};

/// `closed`. It omits the distribution of answers, which may be an outcome.
struct ClosedBody {
  bool complete = false;
  int answers = 0;
  bool one_key = false;
  /// Sealed, because it reveals the levels that an adaptive track reached.
  std::optional<double> largest_force_n{};

  void describe(BodyIo& io) {
    io("complete", complete, "whether the schedule was finished");
    io.omit_if_empty("answers", answers, "number of answers");
    io.omit_if_empty(
        "one_key", one_key,
        "in studies with one plane per trial: of 20 or more answers, 95 % are at one position");
    io("largest_force_n", largest_force_n,
       "largest force sent in any presentation, to tenths of a newton", {.sealed = true});
  }
};

/// The secret of a `closed`: the chain before it. Without the key, nobody can append this end to
/// another chain.
struct ChainEnd {
  std::int64_t length = 0;
  Digest head{};

  void describe(BodyIo& io) {
    io("length", length, "number of events before it", {.min = 1});
    io("head", head, "hash of the last of these events");
  }
  friend bool operator==(const ChainEnd&, const ChainEnd&) = default;
};

/// Rounds to a multiple of 0.1, printed with one decimal.
[[nodiscard]] inline double in_tenths(double number) {
  return std::round(10.0 * number) / 10.0;
}

}  // namespace touchtrial::record
