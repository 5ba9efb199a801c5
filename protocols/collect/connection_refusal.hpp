/// \file Why a server did not let somebody in. Private to protocols/collect.
#pragma once

#include "protocols/collect/server_address.hpp"

namespace touchtrial::collect {

enum class ConnectionRefusal {
  unreached,    ///< nobody answered, the handshake broke off, or the server starts or stops
  too_many,     ///< connections, of all or of this role
  credentials,  ///< user, password, database or rights: will be refused again
};

/// Connects once more, as an error of libpqxx does not have the server's code and its words may be
/// in any language. Takes as long as the address' connect_timeout allows.
/// \return unreached also if it succeeds now
[[nodiscard]] ConnectionRefusal refusal_by(const ServerAddress& address);

}  // namespace touchtrial::collect
