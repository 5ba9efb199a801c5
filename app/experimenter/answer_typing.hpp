/// \file A spoken answer as the experimenter types it.
#pragma once

#include "app/experimenter/request_typing.hpp"
#include "app/experimenter/spoken_answers.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::app {

/// One answer: a label's number and Enter; Enter again to confirm, or another number, once, for a
/// participant who changes it; then the confidence, if it is asked for. Not thread-safe.
class AnswerTyping {
 public:
  /// \param labels  copied
  AnswerTyping(const session::AnswerStep& step, std::vector<std::string> labels);

  void take(char key);
  [[nodiscard]] std::string prompt() const;
  /// Once it is complete.
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

}  // namespace touchtrial::app
