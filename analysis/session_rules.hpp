/// \file The rule that decides which sessions count in a study's results.
#pragma once

#include "protocols/store/study_store.hpp"

namespace touchtrial::analysis {

/// Whether a session counts: it is completed and is neither excluded, erased nor replaced. It is
/// a pilot session exactly if the study is a pilot, and simulated exactly if the study is
/// simulated.
[[nodiscard]] inline bool session_counts(const store::SessionRow& session,
                                         const store::StudyCommitment& commitment) noexcept {
  return session.state == store::SessionState::completed && !session.excluded && !session.erased &&
         session.replaced_by.empty() && session.pilot == commitment.pilot &&
         session.simulated == commitment.simulated;
}

}  // namespace touchtrial::analysis
