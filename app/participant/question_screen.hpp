/// \file A questionnaire, one question at a time.
#pragma once

#include "app/participant/screen.hpp"

#include <string>
#include <vector>

namespace touchtrial::app {

class QuestionScreen final : public Screen {
 public:
  /// \param questionnaire  must outlive this object
  QuestionScreen(const design::Questionnaire& questionnaire, const ScreenContext& context);

 private:
  void paint(Canvas& canvas) override;
  [[nodiscard]] std::optional<session::StepReply> activate(int id, Time at) override;
  [[nodiscard]] int default_target() const noexcept override { return kNextTarget; }
  bool takes_key(const InputEvent& event) override;

  void paint_options(Canvas& canvas, const Box& area);
  void paint_field(Canvas& canvas, const Box& area);
  void choose(int option);
  void write(char32_t letter);
  bool edit(Key key);
  [[nodiscard]] const design::Question& question() const { return questionnaire_.questions[page_]; }
  [[nodiscard]] std::u32string& typed() { return typed_[page_]; }
  [[nodiscard]] bool is_answered() const;
  [[nodiscard]] std::string in_language(const design::Translated& text) const;
  [[nodiscard]] std::vector<std::string> answers() const;

  const design::Questionnaire& questionnaire_;
  ScreenContext context_;
  std::size_t page_ = 0;
  std::vector<int> chosen_;            ///< by question, the option; -1: none
  std::vector<std::u32string> typed_;  ///< by question
  std::size_t caret_ = 0;
};

}  // namespace touchtrial::app
