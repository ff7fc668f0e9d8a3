#include "server/routes/route.h"

namespace cyanometer {

const std::vector<Route>& routes() {
  static const std::vector<Route> table{
      render_post(),      render_link(),    stream_post(),
      stream_link(),      radiance_post(),  plan_post(),
      plan_link(),        compare_post(),   explain_post(),
      attribute_post(),   composite_post(), chart_post(),
      optics_post(),      day_post(),       methods_list(),
      presets_list(),     limits_list(),    schema_document(),
      openapi_document(), healthz(),        readyz(),
      metrics_text(),     page(),
  };
  return table;
}

}  // namespace cyanometer
