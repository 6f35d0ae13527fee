#pragma once

#include <xmlrpcpp/XmlRpcValue.h>

#include <atomic>
#include <optional>
#include <string>
#include <vector>

namespace grinder {

/// Calls a method of a ROS master's or node's XML-RPC API over a connection of its own, for a second at most.
/// @param arguments arguments after this node's name.
/// @param stop set to true to end the call within some hundredths of a second.
/// @return nothing if no answer came, or it is malformed or reports an error.
std::optional<XmlRpc::XmlRpcValue> callRosApi(const std::string& host, unsigned port, const char* method,
                                              const std::vector<XmlRpc::XmlRpcValue>& arguments,
                                              const std::atomic<bool>& stop);

/// A parameter of the ROS master, which has ten seconds to answer: a busy computer must not look like one that has no
/// such parameter.
/// @param name resolved name.
/// @param stop as for callRosApi().
/// @return nothing if it is not set.
/// @throw std::runtime_error if the master does not answer, or `stop` was set.
std::optional<XmlRpc::XmlRpcValue> readParameter(const std::string& name, const std::atomic<bool>& stop);

}  // namespace grinder
