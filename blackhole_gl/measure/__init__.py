"""What methods cost and how far they err, here and now: for the live chart, `plan --measure` and `bench`."""
