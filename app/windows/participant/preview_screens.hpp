/// \file Every screen that participants of a study see, for its designers: without a session, with
/// made-up trials and the pictures in the study file's order.
#pragma once

#include "app/windows/participant/input_event.hpp"
#include "protocols/session/participant.hpp"
#include "protocols/session/session_stages.hpp"
#include "study/study.hpp"

#include <optional>
#include <string>
#include <vector>

namespace touchtrial::app {

struct PreviewScreen {
  std::string name;  ///< unique, for instance "answer"; further pages of one step: "closing-2"
  std::optional<session::Step> step;  ///< empty: a plane is on
  std::vector<InputEvent>
      keys{};             ///< keys that lead from the step's first page to this one; without times
  bool practice = false;  ///< whether it shows the pictures of practice
  /// For a plane that is one of several: the step before it.
  std::optional<session::IntervalStep> interval{};
};

/// All screens, in the order of a session.
/// \param texts  the study's texts; must outlive the result
[[nodiscard]] std::vector<PreviewScreen> preview_screens(const study::Study& study,
                                                         const session::SessionTexts& texts);

/// The labels of a screen's pictures, by position.
[[nodiscard]] std::vector<std::string> preview_labels(const study::Study& study,
                                                      const PreviewScreen& screen);

}  // namespace touchtrial::app
