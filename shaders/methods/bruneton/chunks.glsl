// Chunks of orders, by which all later ones are told (methods/later_orders.glsl). Included after tables.glsl.

// Mean values over the directions of what chunks of orders add, by altitude, sun and group, each over the sum; after
// the last altitude the ground's irradiance. Then the weights of the chunks by sun and group.
int chunk_mean_at(int n, int altitude, int sun) {
  return ((n * (grid.altitudes + 1) + altitude) * grid.suns + sun) * GROUPS;
}
int chunk_weight_at(int n, int sun) {
  return chunk_mean_at(MOST_CHUNKS, 0, 0) + (n * grid.suns + sun) * GROUPS;
}
