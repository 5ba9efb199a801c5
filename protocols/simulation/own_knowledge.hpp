/// \file What the participants of one study learn before it, and what each of them remembers.
/// Source: docs/planning.md, "Training".
#pragma once

#include "protocols/simulation/felt_knowledge.hpp"
#include "protocols/simulation/subject_model.hpp"
#include "study/study.hpp"

#include <cstdint>
#include <memory>

namespace touchtrial::simulation {

/// What a study's participants learn from, by the subject's kind of training: the explorations that
/// all remember (`shared`), or four times as many, of which each remembers some (`own`). A function
/// of its arguments, except for `jobs`. Cost: that of the explorations, 1.5 ms each for 10 s.
/// \param study  of the fields
[[nodiscard]] std::shared_ptr<const FeltKnowledge> learn(const LabelledFields& fields,
                                                         const study::Study& study,
                                                         const SubjectModel& subject,
                                                         std::uint64_t seed, int jobs);

/// What one participant remembers of it: `learnt` itself if all remember the same. A function of
/// its arguments. Cost: some 10 us for 40 examples.
/// \param learnt  from `learn` with this subject
/// \param number  of the participant, from 1
[[nodiscard]] std::shared_ptr<const FeltKnowledge> remembered(
    const std::shared_ptr<const FeltKnowledge>& learnt, const SubjectModel& subject,
    std::uint64_t seed, int number);

}  // namespace touchtrial::simulation
