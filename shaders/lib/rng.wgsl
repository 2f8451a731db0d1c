// Twin of src/kernel/rng.rs.
