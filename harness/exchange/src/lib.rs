//! Files of other tools: image coordinates, photographs.
