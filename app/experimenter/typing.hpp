/// \file What an experimenter types, key by key: requests, the answers that a blindfolded
/// participant speaks, and the day sheet.
#pragma once

#include "protocols/session/experimenter.hpp"
#include "protocols/session/participant.hpp"

#include <cstddef>
#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::app {

/// An answer as the experimenter enters it.
struct SpokenAnswer {
  std::size_t label = 0;             ///< index of the label that was chosen
  std::optional<std::size_t> first;  ///< the previous choice, if the participant changed it
  std::optional<int> confidence;
};

/// Where spoken answers are entered, for instance a terminal.
class SpokenEntry {
 public:
  virtual ~SpokenEntry() = default;
  /// The session's thread calls this repeatedly until there is an answer. May block for a moment.
  /// \param labels  in alphabetical order, so that they reveal nothing about the presentation
  [[nodiscard]] virtual std::optional<SpokenAnswer> spoken_answer(
      const session::AnswerStep& step, const std::vector<std::string>& labels) = 0;
  /// Discards an entry that is not confirmed, because a plane is on.
  virtual void forget_spoken_answer() = 0;
};

/// Shows each step to `participant`, and takes the replies to spoken answers (sight "blindfold")
/// from `entry`. Everything else comes from the participant.
class SpokenAnswers final : public session::Participant {
 public:
  /// \param participant,entry  must outlive this
  SpokenAnswers(session::Participant& participant, SpokenEntry& entry)
      : participant_(participant), entry_(entry) {}

  void see_pictures(const std::vector<std::string>& labels) override;
  [[nodiscard]] std::optional<session::StepReply> attend(const session::Step& step) override;
  [[nodiscard]] device::HapticDevice& begin_exploring(const PlaneGeometry& plane) override {
    entry_.forget_spoken_answer();
    return participant_.begin_exploring(plane);
  }
  void exploring(device::ServoControl& servo) override { participant_.exploring(servo); }
  void feel(const device::ServoSample& sample) noexcept override { participant_.feel(sample); }

 private:
  session::Participant& participant_;
  SpokenEntry& entry_;
  std::vector<std::string> sorted_;
  std::vector<int> positions_;  ///< positions of the sorted labels in the participant's layout
};

/// A line of UTF-8 that keys extend; backspace deletes the last character.
class TypedLine {
 public:
  /// \return whether the key ended the line
  bool take(char key);
  [[nodiscard]] const std::string& text() const noexcept { return text_; }
  void clear() noexcept { text_.clear(); }

 private:
  std::string text_;
};

/// Requests by keys: p pause, r resume, c comfort stop, n note, d deviation, a abort. Pause and
/// comfort stop take effect at once; the reason is typed afterwards and becomes a note (pause) or a
/// deviation (comfort stop). Tab completes a deviation's code to one of the program's, then to the
/// next; another code may be typed. Escape discards a line. Not thread-safe.
class RequestTyping {
 public:
  void take(char key);
  /// Takes the next request; each is returned once.
  [[nodiscard]] std::optional<session::ExperimenterRequest> next();
  /// The question to the experimenter and the line so far; empty if there is no question.
  [[nodiscard]] std::string prompt() const;

 private:
  enum class Field { none, pause_reason, stop_reason, note, code, remark, sure, abort_reason };
  void begin(char key);
  void complete_code();
  void end_line();
  void ask(session::ExperimenterRequest::Kind kind, const std::string& text = {},
           const std::string& code = {});

  Field field_ = Field::none;
  TypedLine line_;
  std::string code_;
  std::deque<session::ExperimenterRequest> requests_;
};

/// A line that lists the keys.
[[nodiscard]] const char* request_keys_help() noexcept;

/// One spoken answer: the number of a label and Enter; then Enter to confirm, or another number,
/// once, for a participant who changes the answer; then the confidence if the step asks for it. Not
/// thread-safe.
class AnswerTyping {
 public:
  /// \param labels  copied
  AnswerTyping(const session::AnswerStep& step, std::vector<std::string> labels);

  void take(char key);
  [[nodiscard]] std::string prompt() const;
  /// The answer, once it is complete.
  [[nodiscard]] const std::optional<SpokenAnswer>& answer() const noexcept { return answer_; }

 private:
  void end_line();
  void choose(int number);

  session::AnswerStep step_;
  std::vector<std::string> labels_;
  TypedLine line_;
  SpokenAnswer typed_;
  bool is_chosen_ = false;
  bool is_confirmed_ = false;
  std::optional<SpokenAnswer> answer_;
};

/// The day sheet, item by item. Enter or y: done; s: skipped, which is a deviation; b: back to the
/// previous item. Not thread-safe.
class TickList {
 public:
  explicit TickList(std::vector<session::DaySheetItem> items);

  void take(char key);
  /// The current item and its keys; empty once all are ticked.
  [[nodiscard]] std::string text() const;
  [[nodiscard]] std::string prompt() const;
  [[nodiscard]] bool is_done() const noexcept { return ticks_.size() == items_.size(); }
  /// The ticks so far, in the items' order.
  [[nodiscard]] const std::vector<session::Tick>& ticks() const noexcept { return ticks_; }

 private:
  std::vector<session::DaySheetItem> items_;
  std::vector<session::Tick> ticks_;
};

}  // namespace touchtrial::app
