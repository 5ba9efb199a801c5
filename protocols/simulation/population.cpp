#include "protocols/simulation/population.hpp"

#include "core/errors.hpp"
#include "study/protocol.hpp"

#include <map>

namespace touchtrial::simulation {
namespace {

std::map<std::string_view, MakePopulation>& registered_populations() {
  static std::map<std::string_view, MakePopulation> all;
  return all;
}

}  // namespace

void add_population(std::string_view protocol, MakePopulation make) {
  registered_populations()[protocol] = make;
}

std::unique_ptr<const Population> population_of(const PopulationSetting& setting) {
  const study::Study& study = setting.key.study;
  const auto found = registered_populations().find(study.protocol->name);
  if (found != registered_populations().end()) return found->second(setting);
  throw StudyError(one_line("study " + study.name + ": the protocol " + study.protocol_name() +
                            " has no simulated participants; run it with people"));
}

}  // namespace touchtrial::simulation
