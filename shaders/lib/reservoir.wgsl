// Twin of src/kernel/reservoir.rs.
