/// \file What a participant practises on.
#pragma once

#include "app/run/run_study.hpp"
#include "protocols/design/practice.hpp"
#include "protocols/session/practice_textures.hpp"

#include <optional>

namespace touchtrial::app {

/// The practice textures of one participant of a study.
class ParticipantPractice {
 public:
  /// \throws StudyError as PracticeSet
  ParticipantPractice(const RunStudy& study, const PlaneGeometry& plane, int enrolment);

  /// Null if the study has no practice. Valid as long as this.
  [[nodiscard]] const session::PracticeTextures* textures() const noexcept {
    return textures_ ? &*textures_ : nullptr;
  }

 private:
  [[nodiscard]] session::PracticeRound round(int number) const;

  const design::Study& study_;
  int enrolment_;
  std::optional<design::PracticeSet> set_;
  std::optional<session::PracticeTextures> textures_;
};

}  // namespace touchtrial::app
