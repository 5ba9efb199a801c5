/// \file The stations of a study that is kept on a server, as sources to collect from.
#pragma once

#include "protocols/collect/collect.hpp"
#include "protocols/collect/server_address.hpp"

#include <functional>

namespace touchtrial::collect {

/// Holds the derived tables of a server against what was collected from it.
/// \throws DamagedStore naming station and session if they disagree
using DerivedTables = std::function<void(const store::StudyStore& collected)>;

/// Every station, all as they were at one moment, whatever is pushed meanwhile. They share one
/// connection, which lives as long as any of them.
/// \param derived  gets the check of the derived tables at the same moment; may be null
/// \throws StoreError if the server cannot be reached or holds no study of this program's version
/// \throws DamagedStore if something there belongs to no session that was pushed
[[nodiscard]] Stations stations_of_server(const ServerAddress& address,
                                          DerivedTables* derived = nullptr);

}  // namespace touchtrial::collect
