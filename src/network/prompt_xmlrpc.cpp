/// @file
/// Makes connections between nodes without delay. roscpp's XML-RPC thread looks for new work only 10 times a
/// second, and a subscriber needs three such looks until it is connected. This definition overrides the library's in
/// the programs that link it.

#include "network/original_symbol.h"

#include <xmlrpcpp/XmlRpcServer.h>

#include <algorithm>

namespace XmlRpc {

/// Serves requests for a while. @param duration [s]
void XmlRpcServer::work(double duration) {
  using Work = void (*)(XmlRpcServer*, double);
  static const auto next = reinterpret_cast<Work>(grinder::originalSymbol("_ZN6XmlRpc12XmlRpcServer4workEd"));
  constexpr double longest = 0.01;
  next(this, std::min(duration, longest));
}

}  // namespace XmlRpc
