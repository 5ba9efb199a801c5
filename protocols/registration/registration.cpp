#include "protocols/registration/registration.hpp"

#include "protocols/identification/analysis/identification_analysis.hpp"
#include "protocols/identification/design/identification.hpp"
#include "protocols/identification/simulation/identifying_participant.hpp"
#include "protocols/threshold/analysis/threshold_analysis.hpp"
#include "protocols/threshold/design/threshold.hpp"
#include "protocols/threshold/simulation/comparing_participant.hpp"

namespace touchtrial::registration {

void register_protocols() {
  static const bool done = [] {
    design::add_protocol(design::identification::classification());
    design::add_protocol(design::identification::comparison());
    for (const design::Protocol* protocol :
         {&design::identification::classification(), &design::identification::comparison()}) {
      simulation::add_population(protocol->name(), simulation::identification::make_population);
      analysis::add_analysis(protocol->name(), analysis::identification::identification_analysis());
    }
    const design::Protocol& threshold = design::threshold::protocol();
    design::add_protocol(threshold);
    simulation::add_population(threshold.name(), simulation::threshold::make_population);
    analysis::add_analysis(threshold.name(), analysis::threshold::threshold_analysis());
    return true;
  }();
  static_cast<void>(done);
}

}  // namespace touchtrial::registration
