#include "app/experimenter/answer_typing.hpp"

#include <charconv>
#include <utility>

#include <fmt/format.h>

namespace touchtrial::app {
namespace {

/// A whole number from 1 to `most`, and nothing else; 0 otherwise.
int number_in(const std::string& text, int most) {
  int number = 0;
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc{} || stopped != end || number < 1 || number > most) return 0;
  return number;
}

}  // namespace

AnswerTyping::AnswerTyping(const session::AnswerStep& step, std::vector<std::string> labels)
    : step_(step), labels_(std::move(labels)) {}

void AnswerTyping::take(char key) {
  if (!answer_ && line_.take(key)) end_line();
}

void AnswerTyping::choose(int number) {
  const auto label = static_cast<std::size_t>(number - 1);
  if (is_chosen_ && label == typed_.label) return;
  if (is_chosen_) {
    if (typed_.first) return;
    typed_.first = typed_.label;
  }
  typed_.label = label;
  is_chosen_ = true;
}

void AnswerTyping::end_line() {
  const std::string text = line_.text();
  line_.clear();
  if (is_confirmed_) {
    const int confidence = number_in(text, step_.confidence_levels);
    if (confidence == 0) return;
    typed_.confidence = confidence;
    answer_ = typed_;
    return;
  }
  if (const int number = number_in(text, static_cast<int>(labels_.size())); number > 0) {
    choose(number);
  } else if (text.empty() && is_chosen_) {
    is_confirmed_ = true;
    if (step_.confidence_levels == 0) answer_ = typed_;
  }
}

std::string AnswerTyping::prompt() const {
  if (is_confirmed_) {
    return fmt::format("trial {}: confidence, 1 to {}: {}", step_.trial, step_.confidence_levels,
                       line_.text());
  }
  std::string prompt = fmt::format("trial {}:", step_.trial);
  if (is_chosen_) {
    return prompt + fmt::format(" {}; Enter confirms{}: {}", labels_[typed_.label],
                                typed_.first ? "" : ", a number changes it", line_.text());
  }
  for (std::size_t i = 0; i < labels_.size(); ++i) {
    prompt += fmt::format(" {} {}", i + 1, labels_[i]);
  }
  return prompt + ": " + line_.text();
}

}  // namespace touchtrial::app
