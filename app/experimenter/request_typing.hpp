/// \file What an experimenter types, key by key, and what it asks of the session.
#pragma once

#include "protocols/session/experimenter.hpp"

#include <deque>
#include <optional>
#include <string>

namespace touchtrial::app {

/// A line that grows by keys: UTF-8, backspace takes the last character.
class TypedLine {
 public:
  /// \return whether the key ended the line
  bool take(char key);
  [[nodiscard]] const std::string& text() const noexcept { return text_; }
  void clear() noexcept { text_.clear(); }

 private:
  std::string text_;
};

/// Keys p pause, r resume, c comfort stop, n note, d deviation, a abort. Pause and comfort stop
/// are asked for at once; their reason is typed after it and becomes a note. Escape leaves a line
/// without effect. Not thread-safe.
class RequestTyping {
 public:
  void take(char key);
  /// The next request, each once.
  [[nodiscard]] std::optional<session::ExperimenterRequest> next();
  /// What is asked of the experimenter, with what was typed so far; empty: nothing is.
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

/// The keys in a line of their own.
[[nodiscard]] const char* request_keys_help() noexcept;

}  // namespace touchtrial::app
