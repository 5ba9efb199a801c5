/// \file The stations of a study that is kept on a server, as sources to collect from.
#pragma once

#include "protocols/collect/collect.hpp"
#include "protocols/collect/server_address.hpp"

namespace touchtrial {

/// Every station, all as they were at one moment, whatever is pushed meanwhile. They share one
/// connection, which lives as long as any of them.
/// \throws StoreError if the server cannot be reached or holds no study of this program's version
/// \throws DamagedStore if something there belongs to no session that was pushed
[[nodiscard]] Stations stations_of_server(const ServerAddress& address);

}  // namespace touchtrial
