// Twin of src/kernel/pack.rs.
