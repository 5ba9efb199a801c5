/// \file What an experimenter types, key by key: requests, spoken answers, and the day sheet.
#pragma once

#include "app/experimenter/spoken_answers.hpp"
#include "protocols/session/experimenter.hpp"

#include <deque>
#include <optional>
#include <string>
#include <vector>

namespace touchtrial::app {

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
/// comfort stop take effect at once; the reason is typed afterwards and becomes a note. Escape
/// discards a line. Not thread-safe.
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
