#include "protocols/collect/open_study.hpp"

namespace touchtrial {

StudyStore open_study(const std::string& where, TraceUse /*traces*/) {
  return StudyStore::open(where, StudyStore::Access::read_only);
}

}  // namespace touchtrial
