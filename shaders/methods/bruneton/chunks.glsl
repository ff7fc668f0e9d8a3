// Chunks of orders, by which all later ones are told (methods/later_orders.glsl). Included after tables.glsl.

// What chunks of orders add to the source in all directions together, by altitude, sun and group, over the sum of all
// orders; after the last altitude the same of the ground's irradiance. Then the weights of the chunks by sun and group.
int chunk_value_at(int n, int altitude, int sun) {
  return ((n * (grid.altitudes + 1) + altitude) * grid.suns + sun) * GROUPS;
}
int chunk_weight_at(int n, int sun) {
  return chunk_value_at(MOST_CHUNKS, 0, 0) + (n * grid.suns + sun) * GROUPS;
}
