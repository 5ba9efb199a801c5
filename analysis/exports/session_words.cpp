#include "analysis/exports/session_words.hpp"

namespace touchtrial {

const char* text_of(SessionState state) {
  switch (state) {
    case SessionState::completed:
      return "completed";
    case SessionState::stopped:
      return "stopped";
    case SessionState::open:
      break;
  }
  return "open";
}

}  // namespace touchtrial
