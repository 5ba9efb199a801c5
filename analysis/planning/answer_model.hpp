/// \file How likely each answer is to each stimulus, given a subject model: from felt explorations,
/// without drawing answers. Source: docs/fitting.md, "Probabilities of answers".
#pragma once

#include "protocols/session/felt_bank.hpp"
#include "protocols/session/felt_knowledge.hpp"
#include "protocols/session/subject_model.hpp"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::planning {

/// Class index of the picture at each position.
using PictureLayout = std::vector<int>;

/// Probabilities of answers by layout, stimulus (place in the bank) and class that is answered.
class AnswerTable {
 public:
  AnswerTable(int layouts, int stimuli, int classes, bool slopes);

  [[nodiscard]] int classes() const noexcept { return classes_; }
  [[nodiscard]] int stimuli() const noexcept { return stimuli_; }
  /// Of one layout and stimulus, by answer; they add up to 1.
  [[nodiscard]] std::span<double> answers(int layout, int stimulus) noexcept;
  [[nodiscard]] std::span<const double> answers(int layout, int stimulus) const noexcept;
  /// d P(answer) / d bias(picture), [answer x classes + picture]; empty if not asked for.
  [[nodiscard]] std::span<double> slopes(int layout, int stimulus) noexcept;
  [[nodiscard]] std::span<const double> slopes(int layout, int stimulus) const noexcept;

 private:
  [[nodiscard]] std::size_t row(int layout, int stimulus) const noexcept {
    return static_cast<std::size_t>(layout) * stimuli_ + stimulus;
  }

  int stimuli_;
  int classes_;
  std::vector<double> answers_;
  std::vector<double> slopes_;
};

struct AnswerModelOptions {
  int directions = 4;      ///< of noise on each exploration, >= 1
  std::uint64_t seed = 1;  ///< of the shift of the quasi-random points
  int jobs = 1;            ///< threads, >= 1; results do not depend on them
};

/// Which run of explorations to use, of so many equal ones. All by default.
struct BankPart {
  int part = 0;
  int of = 1;
};

/// P(answer | stimulus, layout; subject): the mean over the bank's explorations, and over people of
/// the subject's population, of the probability that FeltDecision gives the answer. The
/// classifier's supports are linear in what is perceived, so that noise moves them along straight
/// lines: each of a fixed set of directions of noise (Sobol's points, shifted at random) is
/// integrated in closed form over all amounts of noise. The same numbers in every call make the
/// result a continuous, almost smooth function of the parameters. Differences between people are
/// among the quasi-random points; Weber fractions come from eight equally likely groups. Immutable;
/// refers to nothing.
class AnswerModel {
 public:
  /// \param classes  labels of the study, in its order
  AnswerModel(const session::FeltKnowledge& knowledge, const session::FeltBank& bank,
              std::vector<std::string> classes, const AnswerModelOptions& options);
  ~AnswerModel();
  AnswerModel(AnswerModel&&) noexcept;

  /// Cost: explorations x directions x stimuli x layouts x some 0.1 us a thread; layouts count
  /// only if positions are preferred.
  /// \param subject  weber > 0; labels are the study's
  /// \param slopes  whether to work out the derivatives by pictures' biases, without lapses
  [[nodiscard]] AnswerTable answers(const session::SubjectModel& subject,
                                    std::span<const PictureLayout> layouts, bool slopes = false,
                                    BankPart part = {}) const;

  [[nodiscard]] const std::vector<std::string>& classes() const noexcept;
  [[nodiscard]] const std::vector<design::StimulusIndex>& stimuli() const noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The mean over the population of the probability of a lapse.
[[nodiscard]] double mean_lapse(const session::SubjectModel& subject);

}  // namespace touchtrial::planning
