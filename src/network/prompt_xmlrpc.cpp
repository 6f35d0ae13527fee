/// @file
/// Makes connections between nodes without delay. roscpp looks for new work of its XML-RPC thread only 10 times a
/// second, and the subscriber of a topic needs that three times until it is connected. This definition overrides the
/// library's own in the programs that it is linked into.

#include "network/original_symbol.h"

#include <xmlrpcpp/XmlRpcServer.h>

#include <algorithm>

namespace XmlRpc {

/// Serves requests for a time. @param duration [s]
void XmlRpcServer::work(double duration) {
  using Work = void (*)(XmlRpcServer*, double);
  static const auto next = reinterpret_cast<Work>(grinder::originalSymbol("_ZN6XmlRpc12XmlRpcServer4workEd"));
  constexpr double longest = 0.01;
  next(this, std::min(duration, longest));
}

}  // namespace XmlRpc
