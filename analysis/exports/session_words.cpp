#include "analysis/exports/session_words.hpp"

namespace touchtrial::analysis {

const char* text_of(store::SessionState state) {
  switch (state) {
    case store::SessionState::completed:
      return "completed";
    case store::SessionState::stopped:
      return "stopped";
    case store::SessionState::open:
      break;
  }
  return "open";
}

}  // namespace touchtrial::analysis
