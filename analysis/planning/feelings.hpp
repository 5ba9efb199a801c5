/// \file Where the feelings of simulated participants come from when studies are simulated by the
/// thousand: from explorations felt once, or from the servo each time.
/// Source: docs/power.md, "The fast path".
#pragma once

#include "engine/perception/felt_features.hpp"
#include "protocols/session/felt_bank.hpp"
#include "protocols/session/felt_knowledge.hpp"
#include "protocols/session/labelled_fields.hpp"
#include "protocols/session/subject_model.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace touchtrial::planning {

/// One presentation to one participant of one simulated study.
struct FeltTrial {
  std::uint64_t study_seed = 0;  ///< as `simulate --seed`
  int participant = 0;           ///< number, from 1
  std::uint64_t nth = 0;         ///< presentation that the participant begins, from 1
  std::uint64_t draw = 0;        ///< random bits, its own
};

/// All functions are functions of their arguments and may be called from any thread.
class Feelings {
 public:
  virtual ~Feelings() = default;
  Feelings() = default;
  Feelings(const Feelings&) = delete;
  Feelings& operator=(const Feelings&) = delete;

  /// What the participants of a study have learnt beforehand.
  [[nodiscard]] virtual std::shared_ptr<const session::FeltKnowledge> knowledge(
      std::uint64_t study_seed) const = 0;
  /// What a stimulus feels like in a presentation, before noise.
  [[nodiscard]] virtual engine::FeltFeatures felt(const design::StimulusIndex& stimulus,
                                                  const FeltTrial& trial) const = 0;
};

struct BankedFeelingsOptions {
  int explorations = 1000;  ///< of each stimulus, for trials
  int trainings = 16;       ///< of which every study has one
  std::uint64_t seed = 1;   ///< of their paths
  int jobs = 1;             ///< threads; what is felt does not depend on them
};

/// Explorations felt once, of which every trial has any, and trainings, of which every study has
/// any. Refers to nothing.
class BankedFeelings final : public Feelings {
 public:
  /// \param study  that the fields are of
  /// \param progress  called from one thread at a time
  BankedFeelings(const session::LabelledFields& fields, const design::Study& study,
                 const session::SubjectModel& subject, const BankedFeelingsOptions& options,
                 const design::Progress& progress = {});

  [[nodiscard]] std::shared_ptr<const session::FeltKnowledge> knowledge(
      std::uint64_t study_seed) const override;
  [[nodiscard]] engine::FeltFeatures felt(const design::StimulusIndex& stimulus,
                                          const FeltTrial& trial) const override;

 private:
  session::FeltBank bank_;
  std::vector<std::shared_ptr<const session::FeltKnowledge>> trainings_;
};

/// Every exploration through hand, device and servo, as `simulate` has them, to the bit.
/// Refers to its arguments, which must outlive it. Some hundred times slower.
class ServoFeelings final : public Feelings {
 public:
  ServoFeelings(const session::LabelledFields& fields, const design::Study& study,
                const session::SubjectModel& subject)
      : fields_(fields), study_(study), subject_(subject) {}

  [[nodiscard]] std::shared_ptr<const session::FeltKnowledge> knowledge(
      std::uint64_t study_seed) const override;
  [[nodiscard]] engine::FeltFeatures felt(const design::StimulusIndex& stimulus,
                                          const FeltTrial& trial) const override;

 private:
  const session::LabelledFields& fields_;
  const design::Study& study_;
  const session::SubjectModel& subject_;
};

}  // namespace touchtrial::planning
