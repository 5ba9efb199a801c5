/// \file What the participants of one study learn before it, and what each of them remembers.
/// Source: docs/planning.md, "Training".
#pragma once

#include "protocols/simulation/felt_knowledge.hpp"
#include "protocols/simulation/subject_model.hpp"
#include "study/study.hpp"

#include <cstdint>
#include <memory>

namespace touchtrial::simulation {

/// The explorations from which a study's participants learn, by the subject's kind of training:
/// those that all remember (`shared`), or four times as many, of which each remembers a quarter
/// (`own`). The result depends on all arguments except `jobs`. Takes 1.5 ms per exploration of 10
/// s.
/// \param study  of the fields
[[nodiscard]] std::shared_ptr<const FeltKnowledge> learn(const LabelledFields& fields,
                                                         const study::Study& study,
                                                         const SubjectModel& subject,
                                                         std::uint64_t seed, int jobs);

/// The part of `learnt` that one participant remembers; `learnt` itself if all remember the same.
/// Takes some 10 us for 40 examples.
/// \param learnt  from `learn` with this subject
/// \param number  of the participant, from 1
[[nodiscard]] std::shared_ptr<const FeltKnowledge> remembered(
    const std::shared_ptr<const FeltKnowledge>& learnt, const SubjectModel& subject,
    std::uint64_t seed, int number);

}  // namespace touchtrial::simulation
