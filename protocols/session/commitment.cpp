#include "protocols/session/commitment.hpp"

#include "core/version.hpp"

namespace touchtrial::session {

store::StudyCommitment commitment_of(const design::StudyKey& key, const engine::Pack& pack,
                                     bool simulated, bool pilot) {
  store::StudyCommitment commitment;
  commitment.study = key.study.name;
  commitment.protocol = name_of(key.study.protocol);
  commitment.study_id = key.study_id;
  commitment.seal = design::study_seal(key);
  commitment.pack = pack.digest();
  commitment.configuration = design::blinded_configuration(key);
  commitment.scored_trials = key.study.scored_trials();
  commitment.positions = static_cast<int>(key.study.classes.size());
  commitment.simulated = simulated;
  commitment.pilot = pilot;
  commitment.program_version = program_version();
  return commitment;
}

}  // namespace touchtrial::session
