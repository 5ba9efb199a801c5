/// \file A session of a simulated participant with a hand of their own, without any window.
#pragma once

#include "app/run/run_options.hpp"
#include "app/run/run_study.hpp"

namespace touchtrial::app {

/// \return as run_study_session
[[nodiscard]] int run_headless(const RunOptions& options, const RunStudy& study);

}  // namespace touchtrial::app
