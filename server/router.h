// From a request to its route, and from what a route throws to a problem document.
#pragma once

#include "server/http/message.h"
#include "server/http/problem.h"
#include "server/service.h"

namespace cyanometer {

class Router {
 public:
  /// `ops_only`: nothing but the operators' routes.
  Router(Service& service, bool ops_only) : service_(service), ops_only_(ops_only) {}

  /// Answers, counts and logs. Never throws.
  Answer answer(const Request& request) const;
  /// The same for what could not be read as a request.
  Answer refuse(const HttpProblem& problem, const std::string& peer) const;

 private:
  Answer dispatch(const Request& request) const;
  std::string label(const Request& request) const;
  std::string allowed_methods(const std::string& path) const;

  Service& service_;
  bool ops_only_;
};

}  // namespace cyanometer
