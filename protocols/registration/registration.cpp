#include "protocols/registration/registration.hpp"

#include "protocols/identification/analysis/identification_analysis.hpp"
#include "protocols/identification/planning/planner.hpp"
#include "protocols/identification/simulation/identifying_participant.hpp"
#include "protocols/identification/study/identification.hpp"
#include "protocols/rating/analysis/rating_analysis.hpp"
#include "protocols/rating/planning/planner.hpp"
#include "protocols/rating/simulation/rating_participant.hpp"
#include "protocols/rating/study/rating.hpp"
#include "protocols/threshold/analysis/threshold_analysis.hpp"
#include "protocols/threshold/planning/planner.hpp"
#include "protocols/threshold/simulation/comparing_participant.hpp"
#include "protocols/threshold/study/threshold.hpp"

namespace touchtrial::registration {

void register_protocols() {
  static const bool is_registered = [] {
    study::add_protocol(study::identification::classification());
    study::add_protocol(study::identification::comparison());
    for (const study::Protocol* protocol :
         {&study::identification::classification(), &study::identification::comparison()}) {
      simulation::add_population(protocol->name, simulation::identification::make_population);
      analysis::add_analysis(protocol->name, analysis::identification::identification_analysis());
      planning::add_planner(protocol->name, planning::identification::identification_planner());
    }
    const study::Protocol& threshold = study::threshold::protocol();
    study::add_protocol(threshold);
    simulation::add_population(threshold.name, simulation::threshold::make_population);
    analysis::add_analysis(threshold.name, analysis::threshold::threshold_analysis());
    planning::add_planner(threshold.name, planning::threshold::threshold_planner());
    const study::Protocol& rating = study::rating::protocol();
    study::add_protocol(rating);
    simulation::add_population(rating.name, simulation::rating::make_population);
    analysis::add_analysis(rating.name, analysis::rating::rating_analysis());
    planning::add_planner(rating.name, planning::rating::rating_planner());
    return true;
  }();
  static_cast<void>(is_registered);
}

}  // namespace touchtrial::registration
