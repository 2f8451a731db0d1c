// Twin of src/kernel/depth.rs.
