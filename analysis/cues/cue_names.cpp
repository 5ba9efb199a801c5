#include "analysis/cues/cue_report.hpp"

namespace touchtrial::analysis {

std::string_view name_of(Cue cue) noexcept {
  switch (cue) {
    case Cue::rms:
      return "rms";
    case Cue::spectrum:
      return "spectrum";
    case Cue::everything:
      break;
  }
  return "everything";
}

std::string_view title_of(Cue cue) noexcept {
  switch (cue) {
    case Cue::rms:
      return "force strength (rms)";
    case Cue::spectrum:
      return "spectrum's shape";
    case Cue::everything:
      break;
  }
  return "everything felt";
}

}  // namespace touchtrial::analysis
