#include "app/run/run_session.hpp"

#include "app/run/attended_session.hpp"
#include "app/run/ending_signals.hpp"
#include "app/run/headless_session.hpp"
#include "app/run/run_study.hpp"
#include "protocols/store/session_lock.hpp"

namespace touchtrial::app {

int run_study_session(const RunOptions& options) {
  const EndingSignals signals;
  const RunStudy study = run_study_for(options);
  const store::SessionLock lock(options.database, options.participant);
  if (!options.is_simulated()) return run_attended(options, study);
  return options.headless ? run_headless(options, study) : run_simulated_at_window(options, study);
}

}  // namespace touchtrial::app
