"""What a sample of a track is."""

#: Of each sample, by its number in `Instant.provenance` and `Track.provenance`.
PROVENANCE = ("measured", "filled", "predicted", "solved")
