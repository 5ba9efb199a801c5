/// \file What nobody has checked on a real device. Each driver lists its own facts, beside its code:
/// docs and the bring-up print them from there.
#pragma once

#include <string>
#include <vector>

namespace touchtrial::device {

/// What of a bring-up settles a fact.
enum class Evidence {
  none,            ///< nothing of it
  opened,          ///< the device became ready
  readings,        ///< how often new readings come
  signs,           ///< those of all readings and forces
  lengths,         ///< a ruler beside the handle
  range,           ///< how far the handle goes
  weight,          ///< a known weight on the handle
  wall,            ///< somebody pressed on a soft floor
  delivered,       ///< the device says which force it exerted
  limits,          ///< the library states stiffness and damping
  program_silent,  ///< the program stopped while force was on
  cable_silent,    ///< the cable was pulled while force was on
  answer,          ///< what a person answers to the fact's question
};

struct UnverifiedFact {
  std::string id;    ///< one word, unique among those of a driver
  std::string what;  ///< a line without a full stop
  Evidence evidence = Evidence::none;
  std::string question{};              ///< of Evidence::answer
  std::vector<std::string> answers{};  ///< its possible answers, one word each
};

}  // namespace touchtrial::device
