/// \file The experimenter's interface at a terminal: a status line that is overwritten, and keys.
#pragma once

#include "app/windows/experimenter/experimenter_desk.hpp"

#include <functional>
#include <optional>
#include <string>

namespace touchtrial::app {

/// The terminal of an experimenter.
struct ExperimenterTerminal {
  /// The next key, if one was pressed; never waits. Null if no keys can be read.
  std::function<std::optional<char>()> key;
  std::function<void(const std::string&)> write;
  /// Whether a line can be overwritten; otherwise every change is a new line.
  bool can_rewrite = false;
  int columns = 80;
  /// Sleeps between two polls for a person's input. Null, as in tests: no sleep.
  std::function<void()> pause;
};

/// Standard input and standard error. Keys are read one by one while a copy of the result exists.
[[nodiscard]] ExperimenterTerminal standard_terminal();

/// A line of UTF-8 text being typed; backspace deletes the last character.
class TypedLine {
 public:
  /// \return whether the key ended the line
  bool add_key(char key);
  [[nodiscard]] const std::string& text() const noexcept { return text_; }
  void set(std::string text) { text_ = std::move(text); }

 private:
  std::string text_;
};

/// Keys that can answer an open question go to it; other keys start actions. In a line, Tab
/// completes to the next choice, and Escape discards the line.
class TerminalFace final : public ExperimenterFace {
 public:
  /// \param desk  must outlive this
  TerminalFace(ExperimenterDesk& desk, ExperimenterTerminal terminal);
  /// Ends the line.
  ~TerminalFace() override;
  TerminalFace(const TerminalFace&) = delete;
  TerminalFace& operator=(const TerminalFace&) = delete;

  void read_input() override;
  void show(const ExperimenterView& view) override;
  void clear_line() override;
  void sleep_briefly() override;
  /// Ends the line that is overwritten, before other output follows.
  void end_line();

 private:
  void handle_key(char key);
  /// \return whether the key belongs to the question
  [[nodiscard]] bool answer_with(const ExperimenterQuestion& question, char key);
  void complete(const ExperimenterQuestion& question);
  [[nodiscard]] std::string prompt(const ExperimenterQuestion& question) const;
  void rewrite(const std::string& line);
  /// Writes a line above the status line.
  void write_above(const std::string& line);

  ExperimenterDesk& desk_;
  ExperimenterTerminal terminal_;
  TypedLine line_;
  std::string prefix_;               ///< the text typed before Tab
  std::size_t question_number_ = 0;  ///< the view's question when line_ was started
  std::string shown_item_;           ///< the last shown question answered by keys
  std::string shown_line_;
  std::string shown_progress_;
  bool is_stop_announced_ = false;
};

}  // namespace touchtrial::app
