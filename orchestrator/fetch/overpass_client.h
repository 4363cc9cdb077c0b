#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "orchestrator/fetch/overpass_query.h"

namespace cuscus::orchestrator {

/// The server could not be reached, or did not answer with the data of a map. Says which.
struct FetchError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Asks the server and passes its answer on as it comes; returns after the last byte of a whole
/// map. Redirections are not followed: the user has named the server. Of https, the certificate is
/// checked against the host's name and the machine's authorities (or those in SSL_CERT_FILE).
/// @throws FetchError, also after data have been passed on
void fetch_map(const OverpassServer& server, const std::string& query, const QueryLimits& limits,
               const std::function<void(std::string_view)>& take);

}  // namespace cuscus::orchestrator
