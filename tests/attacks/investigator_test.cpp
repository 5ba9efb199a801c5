// What the holder of the investigator's key can do.
#include "attacks/forger.hpp"
#include "record/payload_json.hpp"
#include "support/catch.hpp"

#include <vector>

using namespace touchtrial;
using namespace touchtrial::attacks;
using record::EventKind;

namespace {

/// Seals a session anew, with another answer in its first trial.
void alter_first_answer(std::vector<record::Event>& chain, const SecretKey& own) {
  bool is_altered = false;
  Digest previous{};
  for (record::Event& event : chain) {
    auto [opened, secret] = record::opened_event(event, own).value();
    if (opened.kind == EventKind::answered && !is_altered) {
      set(opened, "position", "2");
      is_altered = true;
    }
    if (opened.kind == EventKind::closed) {
      secret = record::to_json(record::ChainEnd{.length = event.sequence, .head = previous});
    }
    opened.previous = previous;
    event = record::sealed_event(opened, secret, own);
    previous = event.hash;
  }
}

}  // namespace

TEST_CASE("whoever holds the investigator's key can write anything; a head elsewhere tells") {
  AttackedStudy study;
  const Digest on_paper = study.store().file_head().hash;
  study.close();
  Forgery forged(study.database());
  const SecretKey own =
      record::unwrap_participant_key(study.key().box(), 2, forged.keys.at(2).participant.value())
          .value();
  alter_first_answer(forged.chains.at(2), own);
  const Signer investigator = study.key().signer();
  forged.relink(&investigator);
  forged.write();
  CHECK(study.found().starts_with("heads: "));
  fs::remove(study.head());
  fs::remove(study.second_head());
  study.open();
  study.close();
  INFO(study.found());
  CHECK(study.found().empty());
  note("an answer altered with the investigator's key, all head files with it", Outcome::possible);
  CHECK_FALSE(study.found_by_head(on_paper).empty());
  note("the same, held against a head on paper", Outcome::named);
}
