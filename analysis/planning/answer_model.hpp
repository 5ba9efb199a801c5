/// \file Answer probabilities for each stimulus under a subject model, integrated over sensory
/// noise instead of simulating answers. Source: docs/planning.md, "Probabilities of answers".
#pragma once

#include "engine/pack/pack.hpp"
#include "protocols/simulation/felt_bank.hpp"
#include "protocols/simulation/felt_knowledge.hpp"
#include "protocols/simulation/subject_model.hpp"
#include "study/prepare.hpp"
#include "study/study_key.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace touchtrial::planning {

/// Class index of the picture at each position.
using PictureLayout = std::vector<int>;

/// \return by class, the nearness of its picture to the first position: 1 at the first, 0 at the
///   last
[[nodiscard]] std::vector<double> nearness_of(const PictureLayout& layout);

/// Probabilities of answers by layout, stimulus (place in the bank) and answered class.
class AnswerTable {
 public:
  /// \param with_slopes  whether the table has derivatives
  AnswerTable(int layouts, int stimuli, int classes, bool with_slopes);

  [[nodiscard]] int classes() const noexcept { return classes_; }
  [[nodiscard]] int stimuli() const noexcept { return stimuli_; }
  /// Probabilities for one layout and stimulus, by answer; their sum is 1.
  [[nodiscard]] std::span<double> answers(int layout, int stimulus) noexcept {
    return part(std::span(answers_), classes_, layout, stimulus);
  }
  [[nodiscard]] std::span<const double> answers(int layout, int stimulus) const noexcept {
    return part(std::span(answers_), classes_, layout, stimulus);
  }
  /// d P(answer) / d bias(picture), [answer x classes + picture]; empty without derivatives.
  [[nodiscard]] std::span<double> slopes(int layout, int stimulus) noexcept {
    return part(std::span(slopes_), classes_ * classes_, layout, stimulus);
  }
  [[nodiscard]] std::span<const double> slopes(int layout, int stimulus) const noexcept {
    return part(std::span(slopes_), classes_ * classes_, layout, stimulus);
  }

 private:
  /// \param numbers  of all layouts and stimuli, `size` each; may be empty
  template <typename Number>
  [[nodiscard]] std::span<Number> part(std::span<Number> numbers, int size, int layout,
                                       int stimulus) const noexcept {
    const std::size_t row = static_cast<std::size_t>(layout) * stimuli_ + stimulus;
    return numbers.empty() ? numbers : numbers.subspan(row * size, size);
  }

  int stimuli_;
  int classes_;
  std::vector<double> answers_;
  std::vector<double> slopes_;
};

struct AnswerModelOptions {
  int directions = 4;      ///< noise directions per exploration, >= 1
  std::uint64_t seed = 1;  ///< shifts the quasi-random points
  int jobs = 1;            ///< threads, >= 1; results do not depend on them
};

/// One of several equal parts of a bank's explorations. The default is the whole bank.
struct BankPart {
  int index = 0;
  int count = 1;
};

/// P(answer | stimulus, layout; subject): the probability that FeltDecision gives the answer,
/// averaged over the bank's explorations and over the people of the subject's population.
///
/// The classifier's supports are linear in the perceived features, so noise moves them along
/// straight lines. Each exploration has a fixed set of noise directions (shifted Sobol points), and
/// the model integrates over the amount of noise along each direction in closed form. Every call
/// uses the same points, so the result is a continuous, almost smooth function of the parameters.
/// The same points also represent differences between people, but noise and thresholds are divided
/// into eight and four equally likely groups. Immutable, thread-safe; keeps no references to its
/// arguments.
class AnswerModel {
 public:
  /// \param classes  labels, in the study's order
  /// \throws std::invalid_argument if an option is out of range
  AnswerModel(const simulation::FeltKnowledge& knowledge, const simulation::FeltBank& bank,
              std::vector<std::string> classes, const AnswerModelOptions& options);
  ~AnswerModel();
  AnswerModel(AnswerModel&&) noexcept;

  /// Cost: explorations x directions x stimuli x layouts x about 0.1 us on one thread; the number
  /// of layouts matters only if positions are preferred.
  /// \param subject  feature_noise > 0; its labels must occur in the study
  /// \param with_slopes  whether to compute the derivatives with respect to the pictures' biases
  /// \throws std::invalid_argument if the study lacks a label
  [[nodiscard]] AnswerTable answers(const simulation::SubjectModel& subject,
                                    std::span<const PictureLayout> layouts,
                                    bool with_slopes = false, BankPart part = {}) const;

  [[nodiscard]] const std::vector<std::string>& classes() const noexcept;
  [[nodiscard]] const std::vector<study::StimulusIndex>& stimuli() const noexcept;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// \return the probability of a lapse, averaged over the population
[[nodiscard]] double mean_lapse(const simulation::SubjectModel& subject);

struct FeltStudyOptions {
  int explorations = 1000;  ///< per stimulus
  int directions = 1;       ///< noise directions per exploration
  /// For the training, with the same effect as the seed of `simulate`, and for the bank's paths.
  std::uint64_t seed = 1;
  int jobs = 1;  ///< threads, >= 1; results do not depend on them
};

/// Trains the subject, simulates a bank of explorations, and builds the model. Cost: see FeltBank.
/// \throws StudyError if the subject names a class that the study does not have
/// \throws FileError if the pack lacks a stimulus
[[nodiscard]] AnswerModel answer_model_of(const study::StudyKey& key, const engine::Pack& pack,
                                          const simulation::SubjectModel& subject,
                                          const FeltStudyOptions& options,
                                          const study::Progress& progress = {});

/// \return the study's stimuli, in the order that FeltBank uses
[[nodiscard]] std::vector<study::StimulusIndex> stimuli_of(const study::StudyKey& key);

/// \return the distinct layouts of participants 1 to `participants`
[[nodiscard]] std::vector<PictureLayout> layouts_of(const study::Study& study, int participants);

}  // namespace touchtrial::planning
