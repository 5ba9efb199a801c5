#include "app/run/run_database.hpp"

#include "app/console.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "protocols/session/commitment.hpp"

#include <string>

namespace touchtrial::app {
namespace {

[[noreturn]] void refuse(const RunOptions& options, const std::string& why) {
  throw StoreError(options.database.string() + ": " + why);
}

void require_same(const store::StudyCommitment& stored, const store::StudyCommitment& ours,
                  const RunOptions& options) {
  if (stored.study_id != ours.study_id || stored.seal != ours.seal) {
    refuse(options,
           "is the database of another study, or of this one before it was prepared anew; "
           "give another --db");
  }
  if (stored.pack != ours.pack) {
    refuse(options, "was begun with another pack; name that with --pack");
  }
  if (stored.pilot != ours.pilot) {
    refuse(options, stored.pilot ? "is the database of a pilot; give --pilot, or another --db"
                                 : "is no pilot's database; give pilot sessions another --db");
  }
  if (stored.simulated != ours.simulated) {
    refuse(options, stored.simulated
                        ? "holds simulated participants; give people another --db"
                        : "holds people's sessions; give simulated participants another --db");
  }
}

}  // namespace

store::StudyStore run_database_for(const RunOptions& options, const RunStudy& study) {
  const store::StudyCommitment ours =
      session::commitment_of(study.key, study.pack, options.is_simulated(), options.pilot);
  if (!is_there(options.database))
    return store::StudyStore::create(options.database, ours, utc_now());
  store::StudyStore store =
      store::StudyStore::open(options.database, store::StudyStore::Access::read_write);
  require_same(store.commitment(), ours, options);
  if (store.stations() > 0) {
    refuse(options,
           "was merged from several stations' databases and takes no sessions of its own; run them "
           "in this station's database, and merge again");
  }
  return store;
}

}  // namespace touchtrial::app
